// Closed forms of Rodrigues, with their series where the angle vanishes.
#include "rigid_motion.h"

#include <cmath>

namespace evolin {

namespace {

// Below it the closed forms cancel, and three terms of the series are exact to the last bit.
constexpr double kSmallAngle = 1e-2;

/// The matrix V with translation of exp(w, v) = V v.
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d cross = skew(rotation);
  const double square = angle * angle;
  const double a = angle < kSmallAngle ? 0.5 - square / 24 + square * square / 720
                                       : (1 - std::cos(angle)) / square;
  const double b = angle < kSmallAngle ? 1.0 / 6 - square / 120 + square * square / 5040
                                       : (angle - std::sin(angle)) / (square * angle);
  return Eigen::Matrix3d::Identity() + a * cross + b * cross * cross;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

Pose expMotion(const Vector6d& twist) {
  const Eigen::Vector3d rotation = twist.head<3>();
  const double angle = rotation.norm();
  Pose motion;
  const double half = angle / 2;
  const double factor = angle > 0 ? std::sin(half) / angle : 0.5;
  motion.rotation.w() = std::cos(half);
  motion.rotation.vec() = factor * rotation;
  motion.rotation.normalize();
  motion.translation = leftJacobian(rotation) * twist.tail<3>();
  return motion;
}

Vector6d logMotion(const Pose& motion) {
  Eigen::Quaterniond q = motion.rotation.normalized();
  if (q.w() < 0) {
    q.coeffs() = -q.coeffs();
  }
  const double sine = q.vec().norm();
  const double angle = 2 * std::atan2(sine, q.w());
  Vector6d twist;
  twist.head<3>() = (sine > 0 ? angle / sine : 2) * q.vec();
  twist.tail<3>() = leftJacobian(twist.head<3>()).partialPivLu().solve(motion.translation);
  return twist;
}

Pose compose(const Pose& a, const Pose& b) {
  Pose product;
  product.rotation = (a.rotation * b.rotation).normalized();
  product.translation = a.rotation * b.translation + a.translation;
  return product;
}

Eigen::Matrix<double, 6, 6> adjoint(const Pose& motion) {
  const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> result = Eigen::Matrix<double, 6, 6>::Zero();
  result.topLeftCorner<3, 3>() = rotation;
  result.bottomRightCorner<3, 3>() = rotation;
  result.bottomLeftCorner<3, 3>() = skew(motion.translation) * rotation;
  return result;
}

bool isFinite(const Pose& motion) {
  return motion.rotation.coeffs().allFinite() && motion.translation.allFinite();
}

}  // namespace evolin
