// Whether the images, depth, poses and intrinsics of a recording belong together.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/evaluation/part_reader.h"
#include "evolin_ros/evaluation/recording_check.h"

namespace evolin {

/// How a recording may have to be read for its parts to fit.
struct Reading {
  int frames = 0;         ///< the pose of image i is the one given to image i + frames
  double seconds = 0;     ///< ... or the one at its stamp + seconds
  double depth = 1;       ///< depths are to be multiplied with this
  bool inverted = false;  ///< the poses are world to camera
  bool flipped = false;   ///< fy has the other sign

  bool isAsGiven() const {
    return frames == 0 && seconds == 0 && depth == 1 && !inverted && !flipped;
  }
};

/// Carries edge pixels of an image by their depth and the poses into another image, and compares
/// what is there: the photometric error is small only where all four fit. Every other reading that
/// is a common mistake is tried as well. Keeps the pixels of at most kAnchors image pairs, spread
/// over the recording.
class AgreementCheck {
 public:
  static constexpr std::size_t kAnchors = 40;
  /// Seconds between the two images of a pair, as near as the rate allows: enough motion to tell
  /// readings apart.
  static constexpr double kSpan = 0.13;
  /// Mean errors are of grey levels of 0 to 255; an edge pixel counts for no more than this, also
  /// where it leaves the image.
  static constexpr double kWorstError = 30;

  /// `images`: how many will come, as far as it is known; 0: unknown, the first ones are looked at.
  /// `max_time_difference`: of a depth image to its image, ns.
  explicit AgreementCheck(std::size_t images,
                          Stamp max_time_difference = kNanosecondsPerSecond / 50);

  void add(const StreamPart& part);

  /// "agreement" findings: none when depth, poses or intrinsics are absent (RecordingCheck says
  /// so), else whether they fit as given, or which reading fits clearly better and what to do.
  std::vector<Finding> findings() const;

 private:
  /// An image whose edges are looked for in a later one.
  struct Anchor {
    std::size_t number = 0;  ///< of the image, from 0
    cv::Mat gray;            ///< CV_8UC1
    std::optional<DepthMap> depth;
    Stamp depth_distance = 0;
    cv::Mat later;  ///< the image `step_` after it; empty until it came
  };

  void addImage(const ImagePart& image);
  void offerDepth(const DepthPart& depth, Anchor* anchor) const;

  std::size_t stride_;
  std::size_t step_ = 1;  ///< images from the first to the second of a pair
  Stamp max_time_difference_;
  std::vector<Stamp> stamps_;  ///< of all images
  std::deque<DepthPart> recent_depths_;
  std::vector<Anchor> anchors_;
  std::optional<Camera> camera_;
  Trajectory trajectory_;
};

}  // namespace evolin
