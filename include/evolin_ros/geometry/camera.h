// Intrinsics of a camera in the conventions of sensor_msgs/CameraInfo.
#pragma once

#include <string>
#include <vector>

namespace evolin {

/// Pinhole intrinsics in pixels, image size in pixels, distortion as sensor_msgs/CameraInfo names
/// it. fy may be negative (ICL-NUIM: y up); it is used as it is.
struct Camera {
  std::string name;
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  std::string distortion_model = "plumb_bob";  ///< plumb_bob, rational_polynomial or equidistant
  std::vector<double> distortion;              ///< D; empty or (not for equidistant) all zero: none
  double depth_factor = 5000;  ///< stored depth units per metre of 16-bit depth images
};

/// Throws Error naming `source`, the value and the expectation when a focal length is zero, a
/// number is not finite, the size is not positive, or the distortion model is unknown or has a
/// wrong number of coefficients.
void validateCamera(const Camera& camera, const std::string& source);

/// Whether the lens moves anything: coefficients that are not all zero, or any for `equidistant`.
bool hasDistortion(const Camera& camera);

/// Whether a pixel of one is the same ray in the other, and the images are of one size; name and
/// depth factor do not count.
bool sameIntrinsics(const Camera& a, const Camera& b);

}  // namespace evolin
