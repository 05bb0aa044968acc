// TUM RGB-D folders: rgb.txt, depth.txt and groundtruth.txt, brought together by time
// (Sturm et al. 2012).
#include <algorithm>
#include <tuple>

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/dataset/trajectory.h"
#include "sequence_plan.h"

namespace evolin {

namespace {

constexpr Stamp kMaxDepthDifference = kNanosecondsPerSecond / 50;

// Depth goes to the nearest image, the closest pairs first, and no image or depth is used twice.
void pairDepth(const std::vector<StampedFile>& depths, SequencePlan* plan) {
  using Candidate = std::tuple<Stamp, std::size_t, std::size_t>;  // difference, image, depth
  std::vector<Candidate> candidates;
  std::size_t first = 0;
  for (std::size_t i = 0; i < plan->frames.size(); ++i) {
    const Stamp stamp = plan->frames[i].stamp;
    while (first < depths.size() && depths[first].stamp < stamp - kMaxDepthDifference) {
      ++first;
    }
    for (std::size_t k = first; k < depths.size() && depths[k].stamp <= stamp + kMaxDepthDifference;
         ++k) {
      candidates.emplace_back(std::max(stamp, depths[k].stamp) - std::min(stamp, depths[k].stamp),
                              i, k);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> used(depths.size(), false);
  for (const auto& [difference, image, depth] : candidates) {
    PlannedFrame& frame = plan->frames[image];
    if (frame.depth.empty() && !used[depth]) {
      frame.depth = depths[depth].file;
      frame.depth_stamp = depths[depth].stamp;
      used[depth] = true;
    }
  }
}

}  // namespace

SequencePlan planTumSequence(const std::filesystem::path& folder, const SequenceOptions& options) {
  if (options.pose_offset.value_or(0) != 0) {
    throw Error(folder.string() + ": pose offset " + std::to_string(*options.pose_offset) +
                ", expected 0 or none: a TUM folder pairs poses with images by time");
  }
  SequencePlan plan;
  plan.layout = Layout::kTum;
  plan.folder = folder;
  plan.image_list = "rgb.txt";
  for (const StampedFile& entry : readStampsFile(folder / plan.image_list)) {
    PlannedFrame frame;
    frame.stamp = entry.stamp;
    frame.image = entry.file;
    plan.frames.push_back(std::move(frame));
  }
  if (plan.frames.empty()) {
    throw ParseError((folder / plan.image_list).string(), 0,
                     "lists no image, expected lines \"stamp file\"");
  }
  if (std::filesystem::exists(folder / "depth.txt")) {
    plan.depth_list = "depth.txt";
    pairDepth(readStampsFile(folder / plan.depth_list), &plan);
  }
  if (std::filesystem::exists(folder / "groundtruth.txt")) {
    const Trajectory trajectory = readTrajectory(folder / "groundtruth.txt");
    for (PlannedFrame& frame : plan.frames) {
      frame.pose = trajectory.at(frame.stamp);
    }
    plan.pose_rule = "by stamp, interpolated";
  }
  return plan;
}

}  // namespace evolin
