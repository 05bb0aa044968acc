// What a ray meets first in a scene, by trying every triangle: slow, and nothing in common with the
// renderer but the scene.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin::test {

class RayOracle {
 public:
  explicit RayOracle(const synthetic::Scene& scene) {
    for (const synthetic::Surface& surface : scene.surfaces) {
      for (std::size_t i = 2; i < surface.corners.size(); ++i) {
        triangles_.push_back({surface.corners[0], surface.corners[i - 1], surface.corners[i]});
      }
    }
  }

  /// Multiple of `direction` at which the ray from `origin` meets the front of a triangle first
  /// (Moeller and Trumbore 1997); infinite when it meets none.
  double firstHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles_) {
      const Eigen::Vector3d e1 = triangle.b - triangle.a;
      const Eigen::Vector3d e2 = triangle.c - triangle.a;
      const Eigen::Vector3d p = direction.cross(e2);
      const double determinant = e1.dot(p);
      if (determinant <= 0) {  // seen from behind, or from the side
        continue;
      }
      const Eigen::Vector3d t = origin - triangle.a;
      const double u = t.dot(p) / determinant;
      const Eigen::Vector3d q = t.cross(e1);
      const double v = direction.dot(q) / determinant;
      const double place = e2.dot(q) / determinant;
      if (u >= 0 && v >= 0 && u + v <= 1 && place > 0 && place < nearest) {
        nearest = place;
      }
    }
    return nearest;
  }

  /// Whether something stands before `point`, more than two micrometres.
  bool hides(const Eigen::Vector3d& eye, const Eigen::Vector3d& point) const {
    const double distance = (point - eye).norm();
    return firstHit(eye, (point - eye) / distance) < distance - 2e-6;
  }

 private:
  struct Triangle {
    Eigen::Vector3d a;
    Eigen::Vector3d b;
    Eigen::Vector3d c;
  };
  std::vector<Triangle> triangles_;
};

/// A world point in a camera: pixel, and depth along the optical axis.
struct Projected {
  double x = 0;
  double y = 0;
  double depth = 0;
};

inline Projected projectPoint(const Camera& camera, const Pose& pose,
                              const Eigen::Vector3d& world) {
  const Eigen::Vector3d p = pose.rotation.conjugate() * (world - pose.translation);
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy, p.z()};
}

/// World direction of the sight line through a pixel, of length 1 along the optical axis.
inline Eigen::Vector3d sightLine(const Camera& camera, const Pose& pose, double x, double y) {
  return pose.rotation *
         Eigen::Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
}

}  // namespace evolin::test
