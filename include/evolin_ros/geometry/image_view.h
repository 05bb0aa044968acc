// The pixels in which a camera's images show what lies before it: images as the sensor gives them,
// or rectified ones.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/clipping.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/lens_distortion.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

/// Points on the plane z = 1 before the camera ("normalised": x right, y down, no unit) to pixels
/// and back. A line stays straight in a rectified view; in a distorted one its endpoints are exact
/// and it is taken for the chord between them. fy may be negative.
class ImageView {
 public:
  /// Images as they come: the camera's distortion is applied. Throws Error as validateCamera().
  static ImageView distorted(const Camera& camera);

  /// Rectified images: `pinhole` has their intrinsics (its distortion is not looked at), and
  /// `rotation` turns directions of the camera into those of the rectified one (R of camera_info).
  /// Throws Error as validateCamera().
  static ImageView rectified(const Camera& pinhole,
                             const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

  ImageSize size() const { return {camera_.width, camera_.height}; }

  /// Not cut at the image's border. None behind the (rectified) camera and beyond the reach of the
  /// lens model.
  std::optional<Eigen::Vector2d> pixelOf(const Eigen::Vector2d& normalized) const;
  std::optional<Eigen::Vector2d> normalizedOf(const Eigen::Vector2d& pixel) const;

  /// The image of a segment in space (metres, camera's frame: z along the optical axis), from where
  /// it enters the image (the outermost pixel centres) to where it leaves it; where a bent border
  /// cuts it several times, the longest part. What is nearer than `near` (metres, > 0) is cut away.
  /// Point 1 stays the end of p1. None when nothing of it is visible.
  std::optional<LineSegment> project(const Segment3d& segment, double near) const;

 private:
  ImageView(const Camera& camera, const Camera& lens, const Eigen::Matrix3d& rotation);

  void findBounds();
  bool shows(const Eigen::Vector2d& normalized) const;

  Camera camera_;
  LensDistortion lens_;
  Eigen::Matrix3d rotation_;
  Rectangle bounds_;  ///< holds the normalised points that the image shows
};

}  // namespace evolin
