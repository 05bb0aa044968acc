// Two lines, 3-D to 3-D: R from the orthogonal frames of the directions' bisectors
// (d_a + d_b, d_a - d_b, their cross product); t from sum_i (I - e_i e_i^T) (R p_i + t - q_i) = 0,
// each line giving the two offsets across it (Zhang and Faugeras 1991 pose the problem for n
// lines).
#include "line_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

Eigen::Matrix3d bisectorFrame(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d frame;
  frame.col(0) = (a + b).normalized();
  frame.col(1) = (a - b).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

std::vector<Pose> alignLines(const DirectedLine& first_a, const DirectedLine& first_b,
                             const DirectedLine& second_a, const DirectedLine& second_b,
                             double min_angle, double max_angle_difference) {
  std::vector<Pose> motions;
  const double limit = std::sin(min_angle);
  if (first_a.direction.cross(first_b.direction).norm() < limit ||
      second_a.direction.cross(second_b.direction).norm() < limit) {
    return motions;
  }
  const Eigen::Matrix3d from = bisectorFrame(first_a.direction, first_b.direction).transpose();
  const double first_angle = angle(first_a.direction, first_b.direction);
  const Eigen::Matrix3d across_a =
      Eigen::Matrix3d::Identity() - second_a.direction * second_a.direction.transpose();
  const Eigen::Matrix3d across_b =
      Eigen::Matrix3d::Identity() - second_b.direction * second_b.direction.transpose();
  const Eigen::LLT<Eigen::Matrix3d> factor(across_a + across_b);
  for (const double sign_a : {1.0, -1.0}) {
    for (const double sign_b : {1.0, -1.0}) {
      const Eigen::Vector3d a = sign_a * second_a.direction;
      const Eigen::Vector3d b = sign_b * second_b.direction;
      if (std::abs(angle(a, b) - first_angle) > max_angle_difference) {
        continue;
      }
      const Eigen::Matrix3d rotation = bisectorFrame(a, b) * from;
      Pose motion;
      motion.rotation = Eigen::Quaterniond(rotation).normalized();
      motion.translation = factor.solve(across_a * (second_a.point - rotation * first_a.point) +
                                        across_b * (second_b.point - rotation * first_b.point));
      motions.push_back(motion);
    }
  }
  return motions;
}

}  // namespace evolin
