// Frames of a folder of line files, each with the depth image and the pose that belong to it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/pose.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin::cli {

struct FrameFolders {
  std::string lines;
  std::string scores;  ///< empty: unscored
  std::string depths;
  std::string depth_associations;  ///< file
  std::string poses;               ///< file
  int pose_offset = 0;
};

struct FrameFiles {
  std::string stem;
  std::filesystem::path lines;
  std::filesystem::path scores;  ///< empty: unscored
  std::filesystem::path depth;   ///< empty: none belongs to this frame
  std::optional<Pose> pose;      ///< camera to world

  bool usable() const { return !depth.empty() && pose.has_value(); }
};

struct FrameList {
  std::vector<FrameFiles> frames;
  /// True: the frames are the rows of the list of depths, as the poses are.
  bool by_depth_list = false;
  std::vector<std::string> line_stems;  ///< of all line files, frames or not
};

/// Scores pair with lines by stem; depth images by the list of image and depth indices, both in
/// order of names. Poses come in one of two numbers, which say what the frames are:
/// - one a line file: the frames are the line files, frame i takes pose row i + pose_offset, and a
///   frame that the list does not name has no depth;
/// - else one a row of the list, as in the published scripts: the frames are the rows, line files
///   that the list does not name are no frames, and row k takes pose row k + pose_offset.
/// With an offset N the number may also be N more. A frame whose pose row does not exist has none.
/// Throws Error or ParseError naming folder or file and the counts when the poses are of another
/// number, for scores and lines of different stems, for a malformed or empty list, an index beyond
/// the files or one that does not rise, for names that are numbers in another order than by value,
/// and for a row of equal indices whose two files have different stems although one of the stems is
/// found in the other folder: a file is missing then, and all behind it would be shifted.
FrameList listFrames(const FrameFolders& folders);

/// Depth images of the frames, all of one size: that of the first frame that has one.
class DepthImages {
 public:
  /// `factor`: stored units a metre. Throws as readStoredDepth() for the first image.
  DepthImages(const std::vector<FrameFiles>& frames, double factor);

  /// Throws as readStoredDepth(), and Error naming both files and both sizes when they differ. The
  /// frame has depth. May be called from several threads at once.
  DepthMap read(const FrameFiles& frame) const;

 private:
  double factor_;
  std::filesystem::path first_;
  ImageSize size_;
};

}  // namespace evolin::cli
