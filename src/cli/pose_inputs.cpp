// Lists of frames and pairs, before any of their files is opened.
#include "pose_inputs.h"

#include <map>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/trajectory.h"
#include "file_pairing.h"

namespace evolin::cli {

namespace {

/// Rows of image index and depth index; unlike a sequence's frames, images are line files here.
void pairDepths(const PoseFiles& files, std::vector<PoseFrame>* frames) {
  const std::vector<std::filesystem::path> depths =
      listFiles(files.depths, {".png", ".tif", ".tiff", ".pgm"});
  int number = 0;
  for (const std::string& line : readLines(files.depth_associations)) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') {
      continue;
    }
    const std::vector<std::string_view> words = splitWords(text);
    if (words.size() != 2) {
      throw ParseError(files.depth_associations, number,
                       std::to_string(words.size()) + " fields in " + quote(text) +
                           ", expected two: image index, depth index");
    }
    const auto index = [&](std::size_t column, const std::string& kind, std::size_t count) {
      const std::optional<double> value = parseDouble(words[column]);
      // Written so that NaN fails too.
      if (!value || !(*value >= 0 && *value < static_cast<double>(count)) ||
          *value != static_cast<double>(static_cast<std::size_t>(*value))) {
        throw ParseError(files.depth_associations, number,
                         kind + " index is " + quote(words[column]) +
                             ", expected a whole number from 0 to " + std::to_string(count) +
                             " exclusive (the number of " + kind + " files)");
      }
      return static_cast<std::size_t>(*value);
    };
    PoseFrame& frame = (*frames)[index(0, "line", frames->size())];
    const std::filesystem::path& depth = depths[index(1, "depth", depths.size())];
    if (!frame.depth.empty()) {
      throw ParseError(
          files.depth_associations, number,
          "image index " + quote(words[0]) + " occurs twice, expected one depth an image");
    }
    frame.depth = depth;
  }
}

void pairPoses(const PoseFiles& files, std::vector<PoseFrame>* frames) {
  const std::vector<Pose> poses = readPoseRows(files.poses);
  const auto count = static_cast<std::int64_t>(poses.size());
  for (std::size_t index = 0; index < frames->size(); ++index) {
    const std::int64_t row = static_cast<std::int64_t>(index) + files.pose_offset;
    if (row >= 0 && row < count) {
      (*frames)[index].pose = poses[static_cast<std::size_t>(row)];
    } else if (files.pose_offset == 0) {
      throw Error(files.poses + ": " + std::to_string(count) + " poses, none for frame " +
                  (*frames)[index].stem + "; expected one a frame (" +
                  std::to_string(frames->size()) + ")");
    }
  }
}

/// A file named after two frames must be theirs.
void checkName(const std::filesystem::path& file, const PoseFrame& first, const PoseFrame& second,
               const FileSet& lines, std::size_t step) {
  const std::string stem = file.stem().string();
  for (std::size_t bar = stem.find('_'); bar != std::string::npos; bar = stem.find('_', bar + 1)) {
    const std::string a = stem.substr(0, bar);
    const std::string b = stem.substr(bar + 1);
    if (lines.files.count(a) > 0 && lines.files.count(b) > 0 &&
        (a != first.stem || b != second.stem)) {
      throw Error(file.string() + ": names frames " + a + " and " + b +
                  ", but its place among the files makes it that of " + first.stem + " and " +
                  second.stem + " (" + std::to_string(step) +
                  " frames apart: line files less association files); expected one file for each "
                  "frame and the one so far behind it");
    }
  }
}

}  // namespace

PoseInputs listPoseInputs(const PoseFiles& files) {
  const FileSet lines = listByStem("lines", files.lines, {".csv"});
  const std::vector<std::filesystem::path> associations = listFiles(files.associations, {".csv"});
  PoseInputs inputs;
  for (const auto& [stem, file] : lines.files) {
    inputs.frames.push_back({stem, file, {}, std::nullopt});
  }
  if (associations.size() >= inputs.frames.size()) {
    throw Error(files.associations + ": " + std::to_string(associations.size()) +
                " association files for " + std::to_string(inputs.frames.size()) +
                " line files in " + files.lines +
                ", expected fewer: the frames step is the difference");
  }
  inputs.step = inputs.frames.size() - associations.size();
  pairDepths(files, &inputs.frames);
  pairPoses(files, &inputs.frames);
  for (std::size_t index = 0; index < associations.size(); ++index) {
    const PoseFrame& first = inputs.frames[index];
    const PoseFrame& second = inputs.frames[index + inputs.step];
    checkName(associations[index], first, second, lines, inputs.step);
    if (!first.pose || !second.pose) {
      ++inputs.without_pose;
    } else if (first.depth.empty() || second.depth.empty()) {
      ++inputs.without_depth;
    } else {
      inputs.pairs.push_back({index, index + inputs.step, associations[index]});
    }
  }
  if (inputs.pairs.empty()) {
    throw Error(files.associations + ": none of " + std::to_string(associations.size()) +
                " pairs of frames can be evaluated, " + std::to_string(inputs.without_pose) +
                " without a pose (" + files.poses + ", --pose-offset " +
                std::to_string(files.pose_offset) + ") and " +
                std::to_string(inputs.without_depth) + " without depth (" +
                files.depth_associations + "); expected at least one with both");
  }
  return inputs;
}

}  // namespace evolin::cli
