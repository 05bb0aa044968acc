// Lists of pairs, before any of their files is opened.
#include "pose_inputs.h"

#include <unordered_set>

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/csv.h"

namespace evolin::cli {

namespace {

/// A file named after two frames must be theirs.
void checkName(const PosePairFiles& pair, const PoseInputs& inputs,
               const std::unordered_set<std::string>& stems) {
  const std::string& first = inputs.list.frames[pair.first].stem;
  const std::string& second = inputs.list.frames[pair.second].stem;
  const std::string stem = pair.associations.stem().string();
  for (std::size_t bar = stem.find('_'); bar != std::string::npos; bar = stem.find('_', bar + 1)) {
    const std::string a = stem.substr(0, bar);
    const std::string b = stem.substr(bar + 1);
    if (stems.count(a) > 0 && stems.count(b) > 0 && (a != first || b != second)) {
      throw Error(pair.associations.string() + ": names frames " + a + " and " + b +
                  ", but its place among the files makes it that of " + first + " and " + second +
                  " (" + std::to_string(inputs.step) +
                  " apart: " + std::to_string(inputs.list.frames.size()) +
                  " frames less the number of association files); expected one file for each "
                  "frame and the one so far behind it");
    }
  }
}

}  // namespace

PoseInputs listPoseInputs(const FrameFolders& folders, const std::string& associations) {
  PoseInputs inputs;
  inputs.list = listFrames(folders);
  const std::vector<FrameFiles>& frames = inputs.list.frames;
  const std::vector<std::filesystem::path> files = listFiles(associations, {".csv"});
  if (files.size() >= frames.size()) {
    const std::string source = inputs.list.by_depth_list ? " rows in " + folders.depth_associations
                                                         : " line files in " + folders.lines;
    throw Error(associations + ": " + std::to_string(files.size()) + " association files for " +
                std::to_string(frames.size()) + source +
                ", expected fewer: the frames step is the difference");
  }
  inputs.step = frames.size() - files.size();
  const std::unordered_set<std::string> stems(inputs.list.line_stems.begin(),
                                              inputs.list.line_stems.end());
  for (std::size_t index = 0; index < files.size(); ++index) {
    const PosePairFiles pair = {index, index + inputs.step, files[index]};
    checkName(pair, inputs, stems);
    const FrameFiles& first = frames[pair.first];
    const FrameFiles& second = frames[pair.second];
    if (!first.pose || !second.pose) {
      ++inputs.without_pose;
    } else if (first.depth.empty() || second.depth.empty()) {
      ++inputs.without_depth;
    } else {
      inputs.pairs.push_back(pair);
    }
  }
  if (inputs.pairs.empty()) {
    throw Error(associations + ": none of " + std::to_string(files.size()) +
                " pairs of frames can be evaluated, " + std::to_string(inputs.without_pose) +
                " without a pose (" + folders.poses + ", --pose-offset " +
                std::to_string(folders.pose_offset) + ") and " +
                std::to_string(inputs.without_depth) + " without depth (" +
                folders.depth_associations + "); expected at least one with both");
  }
  return inputs;
}

}  // namespace evolin::cli
