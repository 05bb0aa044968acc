// Ground-truth lines of a synthetic frame: the parts of physical edges that the camera sees.
#pragma once

#include <cstddef>
#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/clipping.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin::synthetic {

/// A piece of an edge, as shares of the way from `from` to `to`.
struct EdgePart {
  double begin = 0;
  double end = 1;
};

/// Where lines are annotated, in pixels: from the centre of the first pixel to 127/128 of width and
/// height (or the centre of the last pixel, where that is less). The benchmark moves what lies
/// beyond back to there, coordinate by coordinate, which turns lines; ground truth that ends there
/// stays itself.
Rectangle annotatedArea(const Camera& camera);

/// For every edge of the scene the parts that no surface hides from an eye at `eye`, whichever way
/// it looks, in order. Exact: a convex surface hides one interval of an edge, the one inside the
/// surface's pyramid of sight and behind its plane.
std::vector<std::vector<EdgePart>> exposedParts(const Scene& scene, const Vector3& eye);

/// For every edge of the scene its visible parts, in order: exposed, before the near plane and
/// inside the annotated area.
std::vector<std::vector<EdgePart>> visibleParts(const Scene& scene, const Camera& camera,
                                                const Pose& camera_to_world);

/// A ground-truth line and where it comes from.
struct VisibleLine {
  LineSegment line;  ///< without an id
  std::size_t edge = 0;
  EdgePart reach;  ///< what is seen of the edge, and beyond the picture's border what is exposed
};

/// Projections of all visible parts of at least kMinLength pixels, by edge and along it; point 1 is
/// the end towards the edge's `from`. All physical edges count, also those whose two sides happen
/// to be equally bright, but for twins: where lines of different edges run within kTwinDistance of
/// each other for at least kMinLength, as at the far side of a face that is seen edge-on, no
/// detector could tell them apart, and that stretch is taken away from the shorter line.
std::vector<VisibleLine> visibleLines(const Scene& scene, const Camera& camera,
                                      const Pose& camera_to_world);

constexpr double kMinLength = 10;    ///< px
constexpr double kTwinDistance = 2;  ///< px

}  // namespace evolin::synthetic
