// What a lens does to directions: the distortion models of sensor_msgs/CameraInfo and their
// inverses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "evolin_ros/geometry/camera.h"

namespace evolin {

/// Maps points of the plane z = 1 before the camera (x right, y down, no unit) to where the lens
/// puts them on it, and back. plumb_bob and rational_polynomial as OpenCV's calib3d defines them,
/// thin prism and tilted sensor included; equidistant as its fisheye model (Kannala and Brandt
/// 2006). Far from the axis a polynomial turns back, and points beyond would come to lie among
/// those inside: they have no image here.
class LensDistortion {
 public:
  /// Throws Error as validateCamera() for the camera's distortion; its other fields are not looked
  /// at.
  explicit LensDistortion(const Camera& camera);

  /// False where the lens moves nothing.
  bool isDistorted() const { return model_ != Model::kNone; }

  /// None for a point that is not finite or lies beyond the reach of the model.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& point) const;

  /// The inverse, to about 1e-12; none where no point within the reach has this image.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  /// Distance from the axis up to which distances grow; on the plane z = 1. At most kFarthest.
  double reach() const { return reach_; }

  static constexpr double kFarthest = 57;  ///< about 89 degrees off the axis

 private:
  enum class Model { kNone, kPolynomial, kEquidistant };

  /// Value and derivative of a function of one variable.
  struct Slope {
    double value;
    double derivative;
  };

  /// The factor of the polynomial models by the squared distance from the axis.
  Slope radialFactor(double squared) const;
  /// Distance from the axis after distortion: of the angle (equidistant) or of the distance.
  Slope radial(double at) const;
  double findReach() const;
  /// The angle or distance whose radial() is `distorted`, or the end of the reach.
  double invertRadial(double distorted) const;
  Eigen::Vector2d bend(const Eigen::Vector2d& point, Eigen::Matrix2d* jacobian) const;
  std::optional<Eigen::Vector2d> unbend(const Eigen::Vector2d& bent) const;

  Model model_ = Model::kNone;
  std::array<double, 14> d_ = {};  ///< D, padded with zeros
  Eigen::Matrix3d tilt_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d untilt_ = Eigen::Matrix3d::Identity();
  double end_ = 0;  ///< of the argument of radial()
  double reach_ = kFarthest;
};

}  // namespace evolin
