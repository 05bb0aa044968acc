// Interpolation between rigid motions, and their inverse.
#include "evolin_ros/geometry/pose.h"

namespace evolin {

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  Pose result;
  result.rotation = a.rotation.slerp(fraction, b.rotation).normalized();
  result.translation = (1 - fraction) * a.translation + fraction * b.translation;
  return result;
}

Pose inverse(const Pose& pose) {
  const Eigen::Quaterniond rotation = pose.rotation.conjugate();
  return {rotation, -(rotation * pose.translation)};
}

}  // namespace evolin
