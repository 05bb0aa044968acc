// ICL-NUIM folders in their TUM-compatible form: associations.txt and a trajectory by frame number
// (Handa et al. 2014).
#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/trajectory.h"
#include "sequence_plan.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

struct ListedFile {
  std::int64_t number = 0;
  std::string file;
};

struct Association {
  ListedFile image;
  ListedFile depth;
};

constexpr const char* kExpectedRow =
    "expected \"number depth/FILE number rgb/FILE\" (in either order)";

bool isDepthFile(const std::string& file) { return file.rfind("depth/", 0) == 0; }

Association parseRow(const std::string& file, int line, std::string_view text) {
  const std::vector<std::string_view> words = splitWords(text);
  if (words.size() != 4) {
    throw ParseError(
        file, line,
        std::to_string(words.size()) + " fields in " + quote(text) + ", " + kExpectedRow);
  }
  ListedFile listed[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string_view word = words[2 * side];
    const std::optional<std::int64_t> number = parseInteger(word);
    if (!number || *number < 0 || *number > kLargestFrameNumber) {
      throw ParseError(file, line,
                       "the frame number is " + quote(word) + ", " + kExpectedRow +
                           " with whole numbers from 0 to " + std::to_string(kLargestFrameNumber));
    }
    listed[side] = {*number, fs::path(words[2 * side + 1]).lexically_normal().string()};
  }
  if (isDepthFile(listed[0].file) == isDepthFile(listed[1].file)) {
    throw ParseError(
        file, line,
        (isDepthFile(listed[0].file) ? "two files of depth/ in " : "no file of depth/ in ") +
            quote(text) + ", " + kExpectedRow);
  }
  return isDepthFile(listed[0].file) ? Association{listed[1], listed[0]}
                                     : Association{listed[0], listed[1]};
}

// The one file of its kind; `preferred` decides between several.
fs::path chooseFile(const fs::path& folder, const std::vector<fs::path>& files,
                    const std::string& kind, const std::string& preferred) {
  const auto found = std::find(files.begin(), files.end(), folder / preferred);
  if (found != files.end()) {
    return *found;
  }
  if (files.size() > 1) {
    throw Error(folder.string() + ": several files " + kind + " (" + files[0].filename().string() +
                ", " + files[1].filename().string() + "), expected one");
  }
  return files.front();
}

std::vector<Association> readAssociations(const fs::path& file) {
  std::vector<Association> rows;
  int number = 0;
  for (const std::string& line : readLines(file)) {
    ++number;
    const std::string_view text = trim(line);
    if (!text.empty() && text.front() != '#') {
      rows.push_back(parseRow(file.string(), number, text));
    }
  }
  if (rows.empty()) {
    throw ParseError(file.string(), 0, std::string("lists no image, ") + kExpectedRow);
  }
  return rows;
}

void assignPosesByNumber(const std::vector<NumberedPose>& poses,
                         const std::vector<Association>& rows, SequencePlan* plan) {
  std::unordered_map<std::int64_t, const Pose*> by_number;
  for (const NumberedPose& pose : poses) {
    by_number.emplace(pose.number, &pose.pose);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto found = by_number.find(rows[i].image.number);
    if (found != by_number.end()) {
      plan->frames[i].pose = *found->second;
    }
  }
  plan->pose_rule = "by frame number";
}

}  // namespace

SequencePlan planIclSequence(const fs::path& folder, const SequenceOptions& options) {
  const std::vector<fs::path> lists = findAssociationLists(folder);
  if (lists.empty()) {
    throw Error(folder.string() + ": no associations*.txt, which an ICL-NUIM folder must have");
  }
  const fs::path list = chooseFile(folder, lists, "associations*.txt", "associations.txt");
  const std::vector<Association> rows = readAssociations(list);

  SequencePlan plan;
  plan.layout = Layout::kIcl;
  plan.folder = folder;
  plan.image_list = list.filename().string();
  plan.depth_list = plan.image_list;
  // Numbers that jump back or repeat are no clock.
  const bool increasing = std::is_sorted(
      rows.begin(), rows.end(),
      [](const Association& a, const Association& b) { return a.image.number <= b.image.number; });
  for (const Association& row : rows) {
    PlannedFrame frame;
    const auto order = static_cast<std::int64_t>(plan.frames.size());
    frame.stamp = stampOfFrame(increasing ? row.image.number : order);
    frame.image = row.image.file;
    frame.depth = row.depth.file;
    frame.depth_stamp = increasing ? stampOfFrame(row.depth.number) : frame.stamp;
    plan.frames.push_back(std::move(frame));
  }
  const std::vector<fs::path> trajectories = findFreiburgTrajectories(folder);
  if (!trajectories.empty()) {
    const fs::path file = chooseFile(folder, trajectories, "*.gt.freiburg", "");
    const std::vector<NumberedPose> poses = readNumberedPoses(file);
    if (options.pose_offset) {
      std::vector<Pose> by_row;
      by_row.reserve(poses.size());
      for (const NumberedPose& pose : poses) {
        by_row.push_back(pose.pose);
      }
      assignPosesByRow(by_row, *options.pose_offset, &plan);
    } else {
      assignPosesByNumber(poses, rows, &plan);
    }
  }
  return plan;
}

}  // namespace evolin
