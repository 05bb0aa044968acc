// Motion from two matched lines known in space.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "evolin_ros/geometry/pose.h"

namespace evolin {

/// A line in space: a point of it (any) and its direction, unit norm, of either sign.
struct DirectedLine {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
};

/// Motions that bring `first` a and b to `second` a and b as nearly as two noisy lines allow: the
/// bisectors of the directions exactly, the offsets across both lines in the least-squares sense.
/// As signs of directions are unknown there are up to four; those are left out under which the
/// angles between the two lines differ by more than `max_angle_difference` (radians). None when the
/// lines of either frame are nearer to parallel than `min_angle` (radians).
std::vector<Pose> alignLines(const DirectedLine& first_a, const DirectedLine& first_b,
                             const DirectedLine& second_a, const DirectedLine& second_b,
                             double min_angle, double max_angle_difference);

}  // namespace evolin
