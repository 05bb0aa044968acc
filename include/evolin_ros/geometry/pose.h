// Rigid motion in three dimensions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace evolin {

/// x -> rotation * x + translation, metres. As a camera's pose it maps camera to world, as in TUM's
/// trajectories.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// At `fraction` 0 `a`, at 1 `b`: translation linear, rotation along the shorter arc (slerp).
Pose interpolate(const Pose& a, const Pose& b, double fraction);

/// The motion back; the rotation's norm is 1.
Pose inverse(const Pose& pose);

}  // namespace evolin
