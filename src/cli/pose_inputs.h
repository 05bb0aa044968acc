// The files that relative poses are computed from, put together pair by pair.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "frame_files.h"

namespace evolin::cli {

struct PosePairFiles {
  std::size_t first = 0;  ///< place among the frames
  std::size_t second = 0;
  std::filesystem::path associations;
};

struct PoseInputs {
  FrameList list;
  std::size_t step = 0;  ///< number of frames less number of association files
  std::vector<PosePairFiles> pairs;
  std::size_t without_pose = 0;  ///< pairs left out because a frame has no pose
  std::size_t without_depth = 0;
};

/// Association file k in order of names belongs to frames k and k + step of listFrames(). Throws
/// Error or ParseError as that does, and when there are no association files or not fewer of them
/// than frames, when one is named FIRST_SECOND after other frames than its place says, and when no
/// pair is left.
PoseInputs listPoseInputs(const FrameFolders& folders, const std::string& associations);

}  // namespace evolin::cli
