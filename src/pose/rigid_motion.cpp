// Closed forms of Rodrigues, with their series where the angle vanishes.
#include "rigid_motion.h"

#include <cmath>

namespace evolin {

namespace {

// Below it the closed forms cancel, and three terms of the series are exact to the last bit.
constexpr double kSmallAngle = 1e-2;

/// V = I + a [w]x + b [w]x^2 with translation of exp(w, v) = V v.
struct LeftJacobian {
  explicit LeftJacobian(double angle) {
    const double square = angle * angle;
    const bool small = angle < kSmallAngle;
    a = small ? 0.5 - square / 24 + square * square / 720 : (1 - std::cos(angle)) / square;
    b = small ? 1.0 / 6 - square / 120 + square * square / 5040
              : (angle - std::sin(angle)) / (square * angle);
  }

  double a;
  double b;
};

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
  const double square = half * half;
  const bool small = angle < kSmallAngle;
  const double factor = small ? 0.5 - square / 12 + square * square / 240 : std::sin(half) / angle;
  motion.rotation.w() = small ? 1 - square / 2 + square * square / 24 : std::cos(half);
  motion.rotation.vec() = factor * rotation;
  motion.rotation.normalize();
  const LeftJacobian jacobian(angle);
  const Eigen::Vector3d shift = twist.tail<3>();
  const Eigen::Vector3d turned = rotation.cross(shift);
  motion.translation = shift + jacobian.a * turned + jacobian.b * rotation.cross(turned);
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
  const LeftJacobian jacobian(angle);
  const Eigen::Matrix3d cross = skew(twist.head<3>());
  const Eigen::Matrix3d left =
      Eigen::Matrix3d::Identity() + jacobian.a * cross + jacobian.b * cross * cross;
  twist.tail<3>() = left.partialPivLu().solve(motion.translation);
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
