// How much light falls on a point of a scene: area lights with soft shadows, and light from all
// around that corners and gaps keep out.
#pragma once

#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"

namespace evolin::synthetic {

/// Keeps its own copy of what it needs; safe for any number of threads.
class Lighting {
 public:
  explicit Lighting(const Scene& scene);

  /// Light on a matt surface at `point` (metres) that faces `normal`; 1 is a well-lit white wall.
  Color at(const Vector3& point, const Vector3& normal) const;

  /// Whether something solid stands on the surface there, so that nobody sees the point.
  bool covered(const Vector3& point, const Vector3& normal) const;

 private:
  struct Blocker {
    Vector3 normal;
    double offset = 0;           ///< normal . x of the plane
    std::vector<Vector3> sides;  ///< a point of the plane is inside when sides[i] . x >= limits[i]
    std::vector<double> limits;
  };
  struct BlockerGroup {
    std::size_t first = 0;
    std::size_t last = 0;
    Vector3 low;
    Vector3 high;
  };

  struct Hit {
    double share = 1;          ///< of the ray's reach; 1: nothing nearer
    bool from_behind = false;  ///< the surface was met on its invisible side
  };

  /// The nearest surface along the ray, or with `any` the first one found.
  Hit firstHit(const Vector3& origin, const Vector3& reach, bool any) const;
  double openness(const Vector3& point, const Vector3& normal) const;

  std::vector<Blocker> blockers_;
  std::vector<BlockerGroup> groups_;
  std::vector<AreaLight> lights_;
};

}  // namespace evolin::synthetic
