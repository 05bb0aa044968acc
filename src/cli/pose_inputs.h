// The files that relative poses are computed from, put together pair by pair.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/pose.h"

namespace evolin::cli {

struct PoseFiles {
  std::string lines;
  std::string associations;
  std::string depths;
  std::string poses;
  std::string depth_associations;
  int pose_offset = 0;
};

struct PoseFrame {
  std::string stem;
  std::filesystem::path lines;
  std::filesystem::path depth;  ///< empty: none belongs to this image
  std::optional<Pose> pose;     ///< camera to world
};

struct PosePairFiles {
  std::size_t first = 0;  ///< place among the frames
  std::size_t second = 0;
  std::filesystem::path associations;
};

struct PoseInputs {
  std::vector<PoseFrame> frames;  ///< in order of the line files' names
  std::size_t step = 0;           ///< number of line files less number of association files
  std::vector<PosePairFiles> pairs;
  std::size_t without_pose = 0;  ///< pairs left out because a frame has no pose
  std::size_t without_depth = 0;
};

/// Association file k in order of names belongs to frames k and k + step. Throws Error or
/// ParseError when a folder is missing or empty, when there are not fewer association files than
/// line files, when an association file is named FIRST_SECOND after other frames than its place
/// says, for a malformed list or an index beyond the files, when a frame has no pose without an
/// offset, and when no pair is left.
PoseInputs listPoseInputs(const PoseFiles& files);

}  // namespace evolin::cli
