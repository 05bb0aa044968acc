// A surface as one camera sees it: its outline in the image, and depth and texture place at any
// pixel.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin::synthetic {

/// World to camera for points.
struct View {
  View(const Camera& intrinsics, const Pose& camera_to_world);

  Vector3 toCamera(const Vector3& world) const { return rotation * (world - centre); }
  Eigen::Vector2d toPixel(const Vector3& camera_point) const {
    return {camera.fx * camera_point.x() / camera_point.z() + camera.cx,
            camera.fy * camera_point.y() / camera_point.z() + camera.cy};
  }

  Camera camera;
  Eigen::Matrix3d rotation;  ///< world directions to camera directions
  Vector3 centre;
};

/// A value that is linear over the image.
struct Plane {
  double right = 0;
  double down = 0;
  double at_origin = 0;

  double at(double x, double y) const { return right * x + down * y + at_origin; }
};

struct ProjectedSurface {
  std::size_t patch = 0;
  std::vector<Eigen::Vector2d> outline;  ///< convex, pixels, not clipped to the image
  double top = 0;                        ///< smallest and largest y of the outline
  double bottom = 0;
  Plane inverse_depth;  ///< 1 / z
  Plane u_ray;          ///< texture place: u = z * u_ray - u_origin, likewise v
  Plane v_ray;
  double u_origin = 0;
  double v_origin = 0;

  /// Where the outline cuts the image row at `y`; false when it does not.
  bool span(double y, double* left, double* right) const;
};

/// None when the camera sees the surface from behind, or all of it is nearer than `near`.
std::optional<ProjectedSurface> projectSurface(const Surface& surface, const Patch& patch,
                                               const View& view, double near);

}  // namespace evolin::synthetic
