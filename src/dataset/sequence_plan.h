// What the three layouts have in common: a list of frames made from the folder's lists, before any
// image is opened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin {

struct PlannedFrame {
  Stamp stamp = 0;
  std::string image;                 ///< as listed, relative to the sequence's folder
  std::string depth;                 ///< likewise; "": none belongs to this image
  std::optional<Stamp> depth_stamp;  ///< where `depth` is set
  std::optional<Pose> pose;
};

struct SequencePlan {
  Layout layout = Layout::kAuto;
  std::filesystem::path folder;
  std::string image_list;  ///< file that lists the images; "": they were found in their folder
  std::string depth_list;
  std::vector<PlannedFrame> frames;  ///< in order of time, at least one
  std::string pose_rule = "none";
};

/// Throw Error or ParseError as openSequence() does; images are not opened.
SequencePlan planTumSequence(const std::filesystem::path& folder, const SequenceOptions& options);
SequencePlan planIclSequence(const std::filesystem::path& folder, const SequenceOptions& options);
SequencePlan planEvolinSequence(const std::filesystem::path& folder,
                                const SequenceOptions& options);

/// Largest frame number whose stamp is defined.
constexpr std::int64_t kLargestFrameNumber = 1000000000;

/// Time of frame `number` in a sequence without stamps: 1 s + number / 30 s, to the nearest
/// nanosecond; 0 <= number <= kLargestFrameNumber.
Stamp stampOfFrame(std::int64_t number);

/// Gives frame i the row i + `offset` of `poses`, where there is one, and says so in the rule.
void assignPosesByRow(const std::vector<Pose>& poses, int offset, SequencePlan* plan);

/// Files "associations*.txt" of an ICL-NUIM folder, sorted.
std::vector<std::filesystem::path> findAssociationLists(const std::filesystem::path& folder);

/// Files "*.gt.freiburg", sorted.
std::vector<std::filesystem::path> findFreiburgTrajectories(const std::filesystem::path& folder);

/// The folder's images/ or rgb/, whichever holds images first; empty when neither does.
std::filesystem::path findImageFolder(const std::filesystem::path& folder);

/// Images of a folder by stem; stems that are all numbers go by value.
std::vector<std::filesystem::path> listImages(const std::filesystem::path& folder);

}  // namespace evolin
