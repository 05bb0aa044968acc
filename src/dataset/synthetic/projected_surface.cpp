// Projection of convex polygons with near-plane clipping.
#include "projected_surface.h"

#include <algorithm>
#include <limits>

namespace evolin::synthetic {

namespace {

/// Pixels by which outlines grow, so that no sample falls between surfaces that share a border.
constexpr double kSeam = 1e-6;

std::vector<Vector3> clipNear(const std::vector<Vector3>& corners, double near) {
  std::vector<Vector3> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& a = corners[i];
    const Vector3& b = corners[(i + 1) % corners.size()];
    if (a.z() >= near) {
      kept.push_back(a);
    }
    if ((a.z() >= near) != (b.z() >= near)) {
      kept.emplace_back(a + (b - a) * ((near - a.z()) / (b.z() - a.z())));
    }
  }
  return kept;
}

}  // namespace

View::View(const Camera& intrinsics, const Pose& camera_to_world)
    : camera(intrinsics),
      rotation(camera_to_world.rotation.normalized().toRotationMatrix().transpose()),
      centre(camera_to_world.translation) {}

bool ProjectedSurface::span(double y, double* left, double* right) const {
  if (y < top - kSeam || y > bottom + kSeam) {
    return false;
  }
  const double row = std::clamp(y, top, bottom);
  *left = std::numeric_limits<double>::infinity();
  *right = -*left;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[i + 1 == outline.size() ? 0 : i + 1];
    if ((a.y() <= row && row <= b.y()) || (b.y() <= row && row <= a.y())) {
      const double height = b.y() - a.y();
      const double x = height == 0 ? a.x() : a.x() + (row - a.y()) / height * (b.x() - a.x());
      *left = std::min(*left, x);
      *right = std::max(*right, x);
      if (height == 0) {
        *left = std::min(*left, b.x());
        *right = std::max(*right, b.x());
      }
    }
  }
  *left -= kSeam;
  *right += kSeam;
  return *left <= *right;
}

std::optional<ProjectedSurface> projectSurface(const Surface& surface, const Patch& patch,
                                               const View& view, double near) {
  const Vector3 normal = view.rotation * patch.normal();
  const Vector3 origin = view.toCamera(patch.origin);
  const double offset = normal.dot(origin);
  if (offset >= 0) {
    return std::nullopt;
  }
  std::vector<Vector3> corners;
  corners.reserve(surface.corners.size());
  for (const Vector3& corner : surface.corners) {
    corners.push_back(view.toCamera(corner));
  }
  corners = clipNear(corners, near);
  if (corners.size() < 3) {
    return std::nullopt;
  }
  ProjectedSurface result;
  result.patch = surface.patch;
  result.top = std::numeric_limits<double>::infinity();
  result.bottom = -result.top;
  for (const Vector3& corner : corners) {
    result.outline.push_back(view.toPixel(corner));
    result.top = std::min(result.top, result.outline.back().y());
    result.bottom = std::max(result.bottom, result.outline.back().y());
  }
  const auto over_image = [&view](const Vector3& direction) {
    const Camera& camera = view.camera;
    return Plane{direction.x() / camera.fx, direction.y() / camera.fy,
                 direction.z() - direction.x() * camera.cx / camera.fx -
                     direction.y() * camera.cy / camera.fy};
  };
  const Vector3 u = view.rotation * patch.u;
  const Vector3 v = view.rotation * patch.v;
  result.inverse_depth = over_image(normal / offset);
  result.u_ray = over_image(u);
  result.v_ray = over_image(v);
  result.u_origin = u.dot(origin);
  result.v_origin = v.dot(origin);
  return result;
}

}  // namespace evolin::synthetic
