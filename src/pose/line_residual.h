// The observation of a point of a line: how far its image is from the line seen, and how that
// changes with the motion.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/pose/matched_lines.h"

namespace evolin {

/// Homogeneous image line through a segment's ends, in pixels: the cross product of the two, so
/// that its value at a pixel is the distance times the segment's length; `normalised`: the distance
/// alone (a segment without length then gives a line that is not finite).
inline Eigen::Vector3d imageLine(const LiftedLine& line, bool normalised) {
  const Eigen::Vector3d result = line.pixel1.homogeneous().cross(line.pixel2.homogeneous());
  return normalised ? Eigen::Vector3d(result / result.head<2>().norm()) : result;
}

/// e = line . (u, v, 1), u = fx x / z + cx, v = fy y / z + cy, of a point (x, y, z) in the frame of
/// the camera.
inline double lineResidual(const Eigen::Vector3d& line, const Camera& camera,
                           const Eigen::Vector3d& point) {
  return line.x() * (camera.fx * point.x() / point.z() + camera.cx) +
         line.y() * (camera.fy * point.y() / point.z() + camera.cy) + line.z();
}

/// Its gradient with respect to the point.
inline Eigen::Vector3d lineResidualGradient(const Eigen::Vector3d& line, const Camera& camera,
                                            const Eigen::Vector3d& point) {
  const double a = line.x() * camera.fx / point.z();
  const double b = line.y() * camera.fy / point.z();
  return {a, b, -(a * point.x() + b * point.y()) / point.z()};
}

/// Its derivative with respect to d in exp(d) * point, rotation first: the point moves by
/// w x point + v.
inline Eigen::Matrix<double, 1, 6> lineResidualJacobian(const Eigen::Vector3d& point,
                                                        const Eigen::Vector3d& gradient) {
  Eigen::Matrix<double, 1, 6> jacobian;
  jacobian << point.cross(gradient).transpose(), gradient.transpose();
  return jacobian;
}

}  // namespace evolin
