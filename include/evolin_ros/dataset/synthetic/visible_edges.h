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

/// For every edge of the scene its visible parts, in order: before the near plane, inside the
/// annotated area and hidden by no surface. Exact: a convex surface hides one interval of an edge,
/// the one inside the surface's pyramid of sight and behind its plane.
std::vector<std::vector<EdgePart>> visibleParts(const Scene& scene, const Camera& camera,
                                                const Pose& camera_to_world);

struct VisibleLines {
  LineSegments lines;              ///< by rising id, at most one an edge
  std::size_t parts_left_out = 0;  ///< long enough, but not the longest of their edge
  std::size_t twins_left_out = 0;  ///< lines that run within kTwinDistance of a longer one
};

/// Projections of the visible parts of at least kMinLength pixels; `id` is the edge's. Of an edge
/// that is seen in several parts the longest alone is taken, because an id names one line of a
/// frame. All physical edges count, also those whose two sides happen to be equally bright, but for
/// lines that run within kTwinDistance of a longer one all their way, as at the far side of a face
/// that is seen edge-on: no detector could tell the two apart.
VisibleLines visibleLines(const Scene& scene, const Camera& camera, const Pose& camera_to_world);

constexpr double kMinLength = 10;    ///< px
constexpr double kTwinDistance = 2;  ///< px

}  // namespace evolin::synthetic
