// Photometric error on edges between image pairs under different readings of a recording.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/evaluation/agreement_check.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/image_view.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

struct BestReading {
  Reading reading;                    ///< as given unless another is clearly better
  std::vector<Reading> alternatives;  ///< not clearly worse than the one given, where that is best
};

class PhotometricAgreement {
 public:
  /// `stamps` of all images; they and the trajectory outlive this object. `worst`: the most that a
  /// pixel counts for, grey levels.
  PhotometricAgreement(const Camera& camera, const Trajectory& trajectory,
                       const std::vector<Stamp>& stamps, double worst);

  /// A pair by the numbers of its images (CV_8UC1). Without enough edges of known depth it is left
  /// out.
  void add(std::pair<std::size_t, std::size_t> numbers, const cv::Mat& first, const DepthMap& depth,
           const cv::Mat& second);

  /// Pairs that have poses under a reading.
  std::size_t pairs(const Reading& reading) const;

  /// Over the pairs that have poses under it, grey levels; NaN where none has.
  double meanError(const Reading& reading) const;

  /// Conventions with shifts of -2 to 2 frames, units of depth and small offsets in time first,
  /// then factors of depth from the best so far.
  BestReading findBest() const;

 private:
  struct EdgePoint {
    Eigen::Vector3d place;    ///< metres, camera's frame
    Eigen::Vector3d flipped;  ///< the same with the other sign of fy
    double level;             ///< grey level there
  };
  struct Pair {
    std::size_t first;
    std::size_t second;
    std::vector<EdgePoint> points;
    cv::Mat image;  ///< the second, CV_32FC1, smoothed
  };

  std::optional<Pose> poseOf(std::size_t image, const Reading& reading) const;
  /// NaN without poses.
  double errorOf(const Pair& pair, const Reading& reading) const;
  std::vector<double> errors(const Reading& reading) const;
  /// `start` unless others' errors are clearly less than this share of its own.
  Reading bestOf(const Reading& start, const std::vector<Reading>& others, double share) const;

  ImageView view_;
  ImageView flipped_view_;
  const Trajectory& trajectory_;
  const std::vector<Stamp>& stamps_;
  double worst_;
  std::vector<Pair> pairs_;
};

}  // namespace evolin
