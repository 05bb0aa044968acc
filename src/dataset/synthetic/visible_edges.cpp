// Hidden-line removal with half spaces: every condition on a point of an edge is linear.
#include "evolin_ros/dataset/synthetic/visible_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "evolin_ros/dataset/synthetic/renderer.h"
#include "projected_surface.h"
#include "twin_lines.h"

namespace evolin::synthetic {

namespace {

/// An edge lies in the planes of its own surfaces up to rounding; what is hidden lies deeper.
constexpr double kBehind = 1e-6;  // m

/// A surface that faces the eye; the eye is the origin.
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

std::vector<Occluder> occludersOf(const Scene& scene, const Vector3& eye) {
  std::vector<Occluder> occluders;
  for (const Surface& surface : scene.surfaces) {
    Occluder occluder;
    occluder.normal = scene.patches[surface.patch].normal();
    std::vector<Vector3> corners;
    for (const Vector3& corner : surface.corners) {
      corners.emplace_back(corner - eye);
    }
    occluder.offset = occluder.normal.dot(corners.front());
    if (occluder.offset >= 0) {
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

std::optional<EdgePart> hiddenPart(const Segment& edge, const Occluder& occluder) {
  EdgePart hidden;
  if (!keepPositive(occluder.offset - kBehind - occluder.normal.dot(edge.from),
                    occluder.offset - kBehind - occluder.normal.dot(edge.to), &hidden)) {
    return std::nullopt;
  }
  for (const Vector3& side : occluder.sides) {
    if (!keepPositive(side.dot(edge.from), side.dot(edge.to), &hidden)) {
      return std::nullopt;
    }
  }
  return hidden;
}

struct SeenPart {
  EdgePart exposed;
  EdgePart seen;  ///< what the view leaves of it
};

/// The view is convex: every exposed part is seen in at most one piece.
std::vector<SeenPart> seenParts(const Edge& edge, const std::vector<EdgePart>& exposed,
                                const View& view) {
  std::vector<SeenPart> parts;
  if (const std::optional<EdgePart> in_view =
          partInView({view.toCamera(edge.from), view.toCamera(edge.to)}, view.camera)) {
    for (const EdgePart& part : exposed) {
      const EdgePart seen{std::max(part.begin, in_view->begin), std::min(part.end, in_view->end)};
      if (seen.begin < seen.end) {
        parts.push_back({part, seen});
      }
    }
  }
  return parts;
}

ProjectedPart project(const Edge& edge, const SeenPart& part, const View& view) {
  const Vector3 span = edge.to - edge.from;
  const Vector3 from = view.toCamera(edge.from + part.seen.begin * span);
  const Vector3 to = view.toCamera(edge.from + part.seen.end * span);
  const Eigen::Vector2d a = view.toPixel(from);
  const Eigen::Vector2d b = view.toPixel(to);
  LineSegment line;
  line.x1 = a.x();
  line.y1 = a.y();
  line.x2 = b.x();
  line.y2 = b.y();
  ProjectedPart projected;
  // Rounding must not carry an end out of the area.
  projected.line = clampToRectangle(line, annotatedArea(view.camera));
  projected.exposed = part.exposed;
  projected.seen = part.seen;
  projected.depth1 = from.z();
  projected.depth2 = to.z();
  return projected;
}

}  // namespace

Rectangle annotatedArea(const Camera& camera) {
  constexpr double kShare = 127.0 / 128;
  return {0, 0, std::min(camera.width - 1.0, camera.width * kShare),
          std::min(camera.height - 1.0, camera.height * kShare)};
}

std::vector<std::vector<EdgePart>> exposedParts(const Scene& scene, const Vector3& eye) {
  const std::vector<Occluder> occluders = occludersOf(scene, eye);
  std::vector<std::vector<EdgePart>> exposed;
  exposed.reserve(scene.edges.size());
  for (const Edge& edge : scene.edges) {
    const Segment seen{edge.from - eye, edge.to - eye};
    std::vector<EdgePart> hidden;
    for (const Occluder& occluder : occluders) {
      if (const std::optional<EdgePart> part = hiddenPart(seen, occluder)) {
        hidden.push_back(*part);
      }
    }
    exposed.push_back(complement(EdgePart(), std::move(hidden)));
  }
  return exposed;
}

std::vector<std::vector<EdgePart>> visibleParts(const Scene& scene, const Camera& camera,
                                                const Pose& camera_to_world) {
  const View view(camera, camera_to_world);
  const std::vector<std::vector<EdgePart>> exposed = exposedParts(scene, view.centre);
  std::vector<std::vector<EdgePart>> visible(scene.edges.size());
  for (std::size_t i = 0; i < scene.edges.size(); ++i) {
    for (const SeenPart& part : seenParts(scene.edges[i], exposed[i], view)) {
      visible[i].push_back(part.seen);
    }
  }
  return visible;
}

std::vector<VisibleLine> visibleLines(const Scene& scene, const Camera& camera,
                                      const Pose& camera_to_world) {
  const View view(camera, camera_to_world);
  const std::vector<std::vector<EdgePart>> exposed = exposedParts(scene, view.centre);
  std::vector<ProjectedPart> parts;
  for (std::size_t i = 0; i < scene.edges.size(); ++i) {
    for (const SeenPart& part : seenParts(scene.edges[i], exposed[i], view)) {
      ProjectedPart projected = project(scene.edges[i], part, view);
      if (projected.line.length() >= kMinLength) {
        projected.edge = i;
        parts.push_back(projected);
      }
    }
  }
  return withoutTwins(std::move(parts));
}

}  // namespace evolin::synthetic
