// Shadow rays to a grid of places on every lamp, and short rays into the half space above a point.
#include "lighting.h"

#include <algorithm>
#include <cmath>

namespace evolin::synthetic {

namespace {

constexpr int kLightGrid = 4;  // places on a lamp: this squared
constexpr int kSkyRings = 3;   // short rays: rings times directions in each
constexpr int kSkyDirections = 8;
constexpr double kSkyReach = 0.7;       // m; farther things do not darken
constexpr double kLeaveSurface = 3e-3;  // m; rays start this far above their surface
constexpr double kTwoPi = 6.283185307179586;

/// Whether the ray origin + t reach, t in [0, far], meets the box.
bool meetsBox(const Vector3& low, const Vector3& high, const Vector3& origin, const Vector3& reach,
              double far) {
  double first = 0;
  double last = far;
  for (int axis = 0; axis < 3; ++axis) {
    if (reach[axis] == 0) {
      if (origin[axis] < low[axis] || origin[axis] > high[axis]) {
        return false;
      }
      continue;
    }
    const double a = (low[axis] - origin[axis]) / reach[axis];
    const double b = (high[axis] - origin[axis]) / reach[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last;
}

}  // namespace

Lighting::Lighting(const Scene& scene) : lights_(scene.lights) {
  for (const Object& object : scene.objects) {
    groups_.push_back({object.first, object.last, object.bounds.min(), object.bounds.max()});
  }
  for (const Surface& surface : scene.surfaces) {
    Blocker blocker;
    blocker.normal = scene.patches[surface.patch].normal();
    blocker.offset = blocker.normal.dot(surface.corners.front());
    for (std::size_t i = 0; i < surface.corners.size(); ++i) {
      const Vector3& corner = surface.corners[i];
      const Vector3 along = surface.corners[(i + 1) % surface.corners.size()] - corner;
      blocker.sides.emplace_back(blocker.normal.cross(along));
      blocker.limits.push_back(blocker.sides.back().dot(corner));
    }
    blockers_.push_back(std::move(blocker));
  }
}

Lighting::Hit Lighting::firstHit(const Vector3& origin, const Vector3& reach, bool any) const {
  Hit nearest;
  for (const BlockerGroup& group : groups_) {
    if (!meetsBox(group.low, group.high, origin, reach, nearest.share)) {
      continue;
    }
    for (std::size_t i = group.first; i < group.last; ++i) {
      const Blocker& blocker = blockers_[i];
      const double approach = blocker.normal.dot(reach);
      const double share = (blocker.offset - blocker.normal.dot(origin)) / approach;
      if (!(share > 0 && share < nearest.share)) {  // also when the ray runs along the plane
        continue;
      }
      const Vector3 place = origin + share * reach;
      std::size_t side = 0;
      while (side < blocker.sides.size() &&
             blocker.sides[side].dot(place) >= blocker.limits[side]) {
        ++side;
      }
      if (side == blocker.sides.size()) {
        nearest = {share, approach > 0};
        if (any) {
          return nearest;
        }
      }
    }
  }
  return nearest;
}

double Lighting::openness(const Vector3& point, const Vector3& normal) const {
  const Vector3 helper = std::abs(normal.z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX();
  const Vector3 u = normal.cross(helper).normalized();
  const Vector3 v = normal.cross(u);
  double open = 0;
  for (int ring = 0; ring < kSkyRings; ++ring) {
    // Rings of equal share under the cosine law.
    const double radius = std::sqrt((ring + 0.5) / kSkyRings);
    const double height = std::sqrt(1 - radius * radius);
    for (int i = 0; i < kSkyDirections; ++i) {
      const double angle = kTwoPi * (i + 0.5 * (ring % 2) + 0.25) / kSkyDirections;
      const Vector3 direction =
          radius * (std::cos(angle) * u + std::sin(angle) * v) + height * normal;
      open += std::sqrt(firstHit(point, kSkyReach * direction, false).share);
    }
  }
  return open / (kSkyRings * kSkyDirections);
}

bool Lighting::covered(const Vector3& point, const Vector3& normal) const {
  return firstHit(point + kLeaveSurface * normal, normal, false).from_behind;
}

Color Lighting::at(const Vector3& point, const Vector3& normal) const {
  const Vector3 start = point + kLeaveSurface * normal;
  // Floor and furniture send warm light up, walls and ceiling white light down.
  const Color around = Color(0.48, 0.48, 0.49) + normal.z() * Color(0.02, 0.03, 0.04) +
                       normal.x() * Color(0.02, 0.02, 0.02) + normal.y() * Color(0.01, 0.01, 0.01);
  Color sum = around * openness(start, normal);
  for (const AreaLight& light : lights_) {
    double received = 0;
    for (int i = 0; i < kLightGrid * kLightGrid; ++i) {
      const int column = i % kLightGrid;
      const int row = i / kLightGrid;
      const double a = (column + 0.5) / kLightGrid;
      const double b = (row + 0.5) / kLightGrid;
      const Vector3 reach = light.origin + a * light.u + b * light.v - start;
      const double here = normal.dot(reach);
      const double there = -light.normal.dot(reach);
      if (here <= 0 || there <= 0) {
        continue;
      }
      // A floor under the square keeps places at the lamp itself from burning out.
      const double square = std::max(reach.squaredNorm(), 0.25);
      if (firstHit(start, reach, true).share >= 1) {
        received += here * there / (square * square);
      }
    }
    sum += light.power * (received / (kLightGrid * kLightGrid));
  }
  return sum;
}

}  // namespace evolin::synthetic
