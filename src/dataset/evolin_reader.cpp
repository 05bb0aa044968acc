// EVOLIN folders: images and lists by row, as the benchmark's published scripts read them.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/depth_associations.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/dataset/trajectory.h"
#include "sequence_plan.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStampsFile = "stamps.txt";
constexpr const char* kDepthAssociations = "depth_associations.txt";

// "images/0000.png" of a file in one of the sequence's folders.
std::string relativeName(const fs::path& file) {
  return (file.parent_path().filename() / file.filename()).string();
}

// Frames in order of the images on disk; times from their numbers in that order.
void listByFolder(const fs::path& images, SequencePlan* plan) {
  for (const fs::path& file : listImages(images)) {
    PlannedFrame frame;
    frame.stamp = stampOfFrame(static_cast<std::int64_t>(plan->frames.size()));
    frame.image = relativeName(file);
    plan->frames.push_back(std::move(frame));
  }
}

// Frames in order of stamps.txt, which also tells of images that are gone. Rows of the other files
// count along file names, so that both orders must be the same.
void listByStamps(const fs::path& images, SequencePlan* plan) {
  const fs::path list = plan->folder / kStampsFile;
  plan->image_list = kStampsFile;
  std::unordered_map<std::string, fs::path> on_disk;
  std::vector<std::string> order;
  for (const fs::path& file : listImages(images)) {
    on_disk.emplace(file.stem().string(), file);
    order.push_back(file.stem().string());
  }
  std::size_t next = 0;
  std::unordered_map<std::string, Stamp> seen;
  for (const StampedFile& entry : readStampsFile(list)) {
    // A name without extension may hold a point of its own (a TUM stamp).
    const fs::path name = fs::path(entry.file).filename();
    const std::string stem = (on_disk.count(name.string()) > 0 ? name : name.stem()).string();
    if (!seen.emplace(stem, entry.stamp).second) {
      throw ParseError(list.string(), 0,
                       "image " + quote(stem) + " is listed twice, expected one stamp an image");
    }
    PlannedFrame frame;
    frame.stamp = entry.stamp;
    const auto found = on_disk.find(stem);
    if (found == on_disk.end()) {
      frame.image = entry.file;
    } else {
      frame.image = relativeName(found->second);
      if (order[next] != stem) {
        throw ParseError(list.string(), 0,
                         "lists image " + quote(stem) + " where " + quote(order[next]) +
                             " is the next by name, expected stamps for all images in order of "
                             "their names");
      }
      ++next;
    }
    plan->frames.push_back(std::move(frame));
  }
  if (next < order.size()) {
    throw ParseError(list.string(), 0,
                     "has no stamp for image " + quote(order[next]) + ", expected one an image");
  }
}

Stamp depthStamp(const SequencePlan& plan, const PlannedFrame& frame, std::size_t depth_row) {
  // The depth image was taken with the image of its own row, where there is one.
  return depth_row < plan.frames.size() ? plan.frames[depth_row].stamp : frame.stamp;
}

void pairDepthByList(const std::vector<fs::path>& depths, SequencePlan* plan) {
  plan->depth_list = kDepthAssociations;
  const std::vector<std::optional<std::size_t>> rows =
      readDepthAssociations(plan->folder / kDepthAssociations, plan->frames.size(), depths.size());
  for (std::size_t image = 0; image < rows.size(); ++image) {
    if (rows[image]) {
      PlannedFrame& frame = plan->frames[image];
      frame.depth = relativeName(depths[*rows[image]]);
      frame.depth_stamp = depthStamp(*plan, frame, *rows[image]);
    }
  }
}

void pairDepthByStem(const std::vector<fs::path>& depths, SequencePlan* plan) {
  std::unordered_map<std::string, fs::path> by_stem;
  for (const fs::path& file : depths) {
    by_stem.emplace(file.stem().string(), file);
  }
  for (PlannedFrame& frame : plan->frames) {
    const auto found = by_stem.find(fs::path(frame.image).stem().string());
    if (found != by_stem.end()) {
      frame.depth = relativeName(found->second);
      frame.depth_stamp = frame.stamp;
    }
  }
}

// Rows say nothing of the image that they belong to, so that one too many or too few would shift
// them all in silence.
void requirePoseOfEveryImage(const fs::path& file, std::size_t poses, int offset,
                             const SequencePlan& plan) {
  const auto images = static_cast<std::int64_t>(plan.frames.size());
  const auto rows = static_cast<std::int64_t>(poses);
  if (rows == images || (rows > 0 && rows == images + offset)) {
    return;
  }
  std::string text = std::to_string(poses) + " poses for " + std::to_string(images) +
                     (plan.image_list.empty() ? " images" : " images of " + plan.image_list) +
                     ", expected one each";
  if (offset != 0) {
    text += ", or " + std::to_string(std::abs(static_cast<std::int64_t>(offset))) +
            (offset > 0 ? " more" : " fewer") + " (pose offset " + std::to_string(offset) + ")";
  }
  throw ParseError(file.string(), 0, text);
}

}  // namespace

SequencePlan planEvolinSequence(const fs::path& folder, const SequenceOptions& options) {
  const fs::path images = findImageFolder(folder);
  if (images.empty()) {
    throw Error(folder.string() +
                ": no images, expected *.png or *.jpg in images/ or rgb/ of an EVOLIN folder");
  }
  SequencePlan plan;
  plan.layout = Layout::kEvolin;
  plan.folder = folder;
  if (fs::exists(folder / kStampsFile)) {
    listByStamps(images, &plan);
  } else {
    listByFolder(images, &plan);
  }
  const bool has_depth = fs::is_directory(folder / "depth");
  if (fs::exists(folder / kDepthAssociations)) {
    if (!has_depth) {
      throw Error((folder / kDepthAssociations).string() +
                  ": there is no folder depth/ beside it, expected the depth images there");
    }
    pairDepthByList(listImages(folder / "depth"), &plan);
  } else if (has_depth) {
    pairDepthByStem(listImages(folder / "depth"), &plan);
  }
  if (fs::exists(folder / "poses.txt")) {
    const std::vector<Pose> poses = readPoseRows(folder / "poses.txt");
    const int offset = options.pose_offset.value_or(0);
    requirePoseOfEveryImage(folder / "poses.txt", poses.size(), offset, plan);
    assignPosesByRow(poses, offset, &plan);
  }
  return plan;
}

}  // namespace evolin
