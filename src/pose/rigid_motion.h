// The exponential of rigid motions and what derivatives with respect to them need.
#pragma once

#include <Eigen/Core>

#include "evolin_ros/geometry/pose.h"

namespace evolin {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The motion of the twist (rotation in radians, translation part in metres).
Pose expMotion(const Vector6d& twist);

/// Inverse of expMotion() for rotations below half a turn.
Vector6d logMotion(const Pose& motion);

/// a after b.
Pose compose(const Pose& a, const Pose& b);

/// Ad with motion * exp(d) = exp(Ad d) * motion; rotation first.
Eigen::Matrix<double, 6, 6> adjoint(const Pose& motion);

/// [v]x with [v]x w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

bool isFinite(const Pose& motion);

}  // namespace evolin
