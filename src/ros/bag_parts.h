// A recorded bag as a stream of the evaluation's parts; no ROS header.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/part_reader.h"

namespace evolin {

struct BagPartsOptions {
  // Topics; "": found by type.
  std::string image_topic;
  std::string depth_topic;
  std::string camera_info_topic;
  std::string pose_topic;  ///< "/tf": the camera's pose in `world_frame` out of tf
  std::string ground_truth_topic;

  std::string world_frame = "world";    ///< of tf, with or without a leading slash
  std::string camera;                   ///< preset or YAML file instead of camera_info; "": none
  std::filesystem::path camera_folder;  ///< where presets are looked up
  std::filesystem::path ground_truth;   ///< folder of annotated lines instead of a topic; "": none
  std::filesystem::path stamps;         ///< of that folder, where it has none; "": none
  bool same_rows = false;               ///< as SequenceOptions
  double depth_factor = 1000;           ///< stored units per metre of 16-bit depth images
  double start = 0;                     ///< seconds to skip from the bag's first message
  std::optional<double> duration;       ///< seconds to take from there; none: all
};

/// Several bags are pieces of one recording. Images are sensor_msgs/Image or CompressedImage; an
/// image topic tells depth from colour by the encoding of its first message. Without a topic for
/// poses /tf is asked, where the bag has it. Throws Error naming file, topic and candidates: no
/// image topic, two that may be meant, a topic that is not there or is of another type.
std::unique_ptr<PartReader> openBagParts(const std::vector<std::filesystem::path>& files,
                                         const BagPartsOptions& options, const WantedParts& wanted);

}  // namespace evolin
