// Hidden-line removal with half spaces: every condition on a point of an edge is linear.
#include "evolin_ros/dataset/synthetic/visible_edges.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "evolin_ros/dataset/synthetic/renderer.h"
#include "projected_surface.h"

namespace evolin::synthetic {

namespace {

/// An edge lies in the planes of its own surfaces up to rounding; what is hidden lies deeper.
constexpr double kBehind = 1e-6;  // m

/// A surface that faces the camera, in camera coordinates.
struct Occluder {
  Vector3 normal;
  double offset = 0;           ///< normal . x of its plane, below 0
  std::vector<Vector3> sides;  ///< a sight line p meets it when every sides[i] . p >= 0
};

struct Segment {
  Vector3 from;
  Vector3 to;
};

/// Cuts `part` down to where the linear function with values `at_from` and `at_to` is at least 0;
/// false when nothing is left.
bool keepPositive(double at_from, double at_to, EdgePart* part) {
  if (at_from < 0 && at_to < 0) {
    return false;
  }
  if (at_from < 0) {
    part->begin = std::max(part->begin, at_from / (at_from - at_to));
  } else if (at_to < 0) {
    part->end = std::min(part->end, at_from / (at_from - at_to));
  }
  return part->begin < part->end;
}

std::optional<EdgePart> partInView(const Segment& edge, const Camera& camera) {
  EdgePart part;
  // c . p >= 0 for the four sides of the image, written without the division by z.
  const auto inside = [&](const Vector3& condition) {
    return keepPositive(condition.dot(edge.from), condition.dot(edge.to), &part);
  };
  const Rectangle area = annotatedArea(camera);
  if (keepPositive(edge.from.z() - Renderer::kNearPlane, edge.to.z() - Renderer::kNearPlane,
                   &part) &&
      inside({camera.fx, 0, camera.cx}) && inside({-camera.fx, 0, area.right - camera.cx}) &&
      inside({0, camera.fy, camera.cy}) && inside({0, -camera.fy, area.bottom - camera.cy})) {
    return part;
  }
  return std::nullopt;
}

std::vector<Occluder> occludersOf(const Scene& scene, const View& view) {
  std::vector<Occluder> occluders;
  for (const Surface& surface : scene.surfaces) {
    Occluder occluder;
    occluder.normal = view.rotation * scene.patches[surface.patch].normal();
    std::vector<Vector3> corners;
    bool in_front = false;
    for (const Vector3& corner : surface.corners) {
      corners.push_back(view.toCamera(corner));
      in_front = in_front || corners.back().z() > Renderer::kNearPlane;
    }
    occluder.offset = occluder.normal.dot(corners.front());
    if (occluder.offset >= 0 || !in_front) {
      continue;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      // Counter-clockwise corners seen from the front: the cross products point outwards.
      occluder.sides.emplace_back(corners[(i + 1) % corners.size()].cross(corners[i]).normalized());
    }
    occluders.push_back(std::move(occluder));
  }
  return occluders;
}

/// The part of `within` that the surface hides.
std::optional<EdgePart> hiddenPart(const Segment& edge, const Occluder& occluder, EdgePart within) {
  if (!keepPositive(occluder.offset - kBehind - occluder.normal.dot(edge.from),
                    occluder.offset - kBehind - occluder.normal.dot(edge.to), &within)) {
    return std::nullopt;
  }
  for (const Vector3& side : occluder.sides) {
    if (!keepPositive(side.dot(edge.from), side.dot(edge.to), &within)) {
      return std::nullopt;
    }
  }
  return within;
}

std::vector<EdgePart> complement(const EdgePart& whole, std::vector<EdgePart> hidden) {
  std::sort(hidden.begin(), hidden.end(),
            [](const EdgePart& a, const EdgePart& b) { return a.begin < b.begin; });
  std::vector<EdgePart> parts;
  double reached = whole.begin;
  for (const EdgePart& part : hidden) {
    if (part.begin > reached) {
      parts.push_back({reached, part.begin});
    }
    reached = std::max(reached, part.end);
  }
  if (reached < whole.end) {
    parts.push_back({reached, whole.end});
  }
  return parts;
}

LineSegment project(const Edge& edge, const EdgePart& part, const View& view) {
  const Vector3 span = edge.to - edge.from;
  const Eigen::Vector2d a = view.toPixel(view.toCamera(edge.from + part.begin * span));
  const Eigen::Vector2d b = view.toPixel(view.toCamera(edge.from + part.end * span));
  LineSegment line;
  line.x1 = a.x();
  line.y1 = a.y();
  line.x2 = b.x();
  line.y2 = b.y();
  const Rectangle area = annotatedArea(view.camera);
  return clampToRectangle(line, area);  // rounding must not carry an end out of it
}

double distanceToSegment(double x, double y, const LineSegment& line) {
  const double dx = line.x2 - line.x1;
  const double dy = line.y2 - line.y1;
  const double share =
      std::clamp(((x - line.x1) * dx + (y - line.y1) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(x - line.x1 - share * dx, y - line.y1 - share * dy);
}

/// Takes away lines with both ends near a longer line and returns how many.
std::size_t removeTwins(LineSegments* lines) {
  const auto isTwin = [lines](const LineSegment& line) {
    return std::any_of(lines->begin(), lines->end(), [&line](const LineSegment& other) {
      const bool longer =
          other.length() > line.length() || (other.length() == line.length() && other.id < line.id);
      return longer && distanceToSegment(line.x1, line.y1, other) < kTwinDistance &&
             distanceToSegment(line.x2, line.y2, other) < kTwinDistance;
    });
  };
  LineSegments kept;
  std::copy_if(lines->begin(), lines->end(), std::back_inserter(kept),
               [&isTwin](const LineSegment& line) { return !isTwin(line); });
  const std::size_t removed = lines->size() - kept.size();
  *lines = std::move(kept);
  return removed;
}

}  // namespace

Rectangle annotatedArea(const Camera& camera) {
  constexpr double kShare = 127.0 / 128;
  return {0, 0, std::min(camera.width - 1.0, camera.width * kShare),
          std::min(camera.height - 1.0, camera.height * kShare)};
}

std::vector<std::vector<EdgePart>> visibleParts(const Scene& scene, const Camera& camera,
                                                const Pose& camera_to_world) {
  const View view(camera, camera_to_world);
  const std::vector<Occluder> occluders = occludersOf(scene, view);
  std::vector<std::vector<EdgePart>> visible(scene.edges.size());
  for (std::size_t i = 0; i < scene.edges.size(); ++i) {
    const Segment edge{view.toCamera(scene.edges[i].from), view.toCamera(scene.edges[i].to)};
    const std::optional<EdgePart> in_view = partInView(edge, camera);
    if (!in_view) {
      continue;
    }
    std::vector<EdgePart> hidden;
    for (const Occluder& occluder : occluders) {
      if (const std::optional<EdgePart> part = hiddenPart(edge, occluder, *in_view)) {
        hidden.push_back(*part);
      }
    }
    visible[i] = complement(*in_view, std::move(hidden));
  }
  return visible;
}

VisibleLines visibleLines(const Scene& scene, const Camera& camera, const Pose& camera_to_world) {
  const View view(camera, camera_to_world);
  const std::vector<std::vector<EdgePart>> parts = visibleParts(scene, camera, camera_to_world);
  VisibleLines result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    LineSegment best;
    double best_length = 0;
    std::size_t long_enough = 0;
    for (const EdgePart& part : parts[i]) {
      const LineSegment line = project(scene.edges[i], part, view);
      if (line.length() < kMinLength) {
        continue;
      }
      ++long_enough;
      if (line.length() > best_length) {
        best = line;
        best_length = line.length();
      }
    }
    if (long_enough > 0) {
      best.id = static_cast<std::int64_t>(i);
      result.lines.push_back(best);
      result.parts_left_out += long_enough - 1;
    }
  }
  result.twins_left_out = removeTwins(&result.lines);
  return result;
}

}  // namespace evolin::synthetic
