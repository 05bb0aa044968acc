// A match as both cameras see it: points of each frame against the image line of the other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "evolin_ros/pose/relative_pose.h"
#include "rigid_motion.h"

namespace evolin {

/// Points of one frame and the image line, of unit norm, that they should fall on in the other.
struct PointsOnLine {
  std::array<Eigen::Vector3d, 2> points;
  Eigen::Vector3d line;
};

struct TwoViewLine {
  PointsOnLine forward;        ///< points of the first frame, line of the second
  PointsOnLine backward;       ///< points of the second frame, line of the first
  Eigen::Vector3d direction1;  ///< of the line in the first frame, unit norm
  Eigen::Vector3d direction2;
  Eigen::Vector2d lengths;  ///< of the segment in the first and in the second image, pixels
  std::size_t place = 0;    ///< among the matches
};

/// Matches without length in an image or in space, or not finite, are left out.
std::vector<TwoViewLine> makeTwoViewLines(const SpatialMatches& matches);

/// Mean squared distance in pixels of the two points, moved by `rotation` and `translation`, from
/// the line; infinite with a point behind the camera.
double squaredDistance(const PointsOnLine& seen, const Eigen::Matrix3d& rotation,
                       const Eigen::Vector3d& translation, const Camera& camera);

/// Both distances in pixels under a motion from first to second, and their derivatives with respect
/// to d in exp(d) * motion. False with a point behind the camera.
struct LinearisedDistances {
  Eigen::Vector2d values;
  Eigen::Matrix<double, 2, 6> jacobian;
};
bool lineariseForward(const TwoViewLine& line, const Pose& motion, const Camera& camera,
                      LinearisedDistances* result);
bool lineariseBackward(const TwoViewLine& line, const Pose& motion, const Camera& camera,
                       LinearisedDistances* result);

/// Sum of weighted normal equations over those of `lines` and directions that `use` marks, with
/// Cauchy weights of the given scale (infinite: equal weights).
struct WeightedEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d right_side = Vector6d::Zero();
  double weighted_squares = 0;
  double weights = 0;  ///< sum over the distances
};
struct Support {
  bool forward = false;
  bool backward = false;
  bool any() const { return forward || backward; }
};
WeightedEquations sumEquations(const std::vector<TwoViewLine>& lines,
                               const std::vector<Support>& use, const Pose& motion,
                               const Camera& camera, double scale);

}  // namespace evolin
