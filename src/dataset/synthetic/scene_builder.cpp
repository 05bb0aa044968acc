// Boxes, frames, and the union of edges along one line.
#include "scene_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evolin::synthetic {

namespace {

constexpr double kSamePlace = 1e-6;  // m

Vector3 normalOf(const std::vector<Vector3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[1]).normalized();
}

/// Replaces `a` by its union with `b` when both lie on one line and touch.
bool unite(Edge* a, const Edge& b) {
  const Vector3 span = a->to - a->from;
  const double length = span.norm();
  const Vector3 direction = span / length;
  const auto place = [&](const Vector3& point, double* along) {
    const Vector3 offset = point - a->from;
    *along = offset.dot(direction);
    return (offset - *along * direction).norm() < kSamePlace;
  };
  double first = 0;
  double second = 0;
  if (!place(b.from, &first) || !place(b.to, &second) ||
      std::min(first, second) > length + kSamePlace || std::max(first, second) < -kSamePlace) {
    return false;
  }
  const Vector3 origin = a->from;
  a->from = origin + std::min({0.0, first, second}) * direction;
  a->to = origin + std::max({length, first, second}) * direction;
  return true;
}

/// In order of first appearance.
std::vector<Edge> uniteCollinear(std::vector<Edge> edges) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t k = i + 1; k < edges.size();) {
      if (unite(&edges[i], edges[k])) {
        edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(k));
        k = i + 1;  // the longer edge may touch what the shorter one did not
      } else {
        ++k;
      }
    }
  }
  return edges;
}

}  // namespace

Vector3 Placement::direction(const Vector3& local) const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {c * local.x() - s * local.y(), s * local.x() + c * local.y(), local.z()};
}

void SceneBuilder::beginObject() {
  scene_.objects.push_back({scene_.surfaces.size(), scene_.surfaces.size(), {}});
}

void SceneBuilder::addPolygon(const std::vector<Vector3>& corners, const Vector3& u,
                              const Material& material) {
  addPieces({corners}, u, material);
}

void SceneBuilder::addPieces(const std::vector<std::vector<Vector3>>& pieces, const Vector3& u,
                             const Material& material) {
  Patch patch;
  patch.u = u.normalized();
  patch.v = normalOf(pieces.front()).cross(patch.u);
  patch.material = material;
  const Vector3& reference = pieces.front().front();
  Eigen::AlignedBox2d extent;
  for (const std::vector<Vector3>& corners : pieces) {
    for (const Vector3& corner : corners) {
      const Vector3 offset = corner - reference;
      extent.extend(Eigen::Vector2d(offset.dot(patch.u), offset.dot(patch.v)));
      scene_.objects.back().bounds.extend(corner);
    }
    scene_.surfaces.push_back({scene_.patches.size(), corners});
  }
  patch.origin = reference + extent.min().x() * patch.u + extent.min().y() * patch.v;
  patch.width = extent.sizes().x();
  patch.height = extent.sizes().y();
  scene_.patches.push_back(patch);
  scene_.objects.back().last = scene_.surfaces.size();
}

void SceneBuilder::addEdge(const Vector3& from, const Vector3& to) {
  Vector3 low = from.z() <= to.z() ? from : to;
  const Vector3& high = from.z() <= to.z() ? to : from;
  if (high.z() < 0) {
    return;
  }
  if (low.z() < 0) {
    low += (high - low) * (-low.z() / (high.z() - low.z()));
  }
  if ((high - low).norm() > kSamePlace) {
    scene_.edges.push_back({low, high});
  }
}

void SceneBuilder::addBox(const Placement& placement, const Vector3& low, const Vector3& size,
                          const Material& material, unsigned open) {
  std::array<Vector3, 8> corner;
  for (unsigned i = 0; i < 8; ++i) {
    corner[i] =
        placement.point(low + Vector3((i & 1U) != 0 ? size.x() : 0, (i & 2U) != 0 ? size.y() : 0,
                                      (i & 4U) != 0 ? size.z() : 0));
  }
  struct FaceCorners {
    unsigned face;
    std::array<unsigned, 4> corners;
  };
  static constexpr FaceCorners kFaces[] = {{kLeft, {2, 0, 4, 6}},   {kRight, {1, 3, 7, 5}},
                                           {kFront, {0, 1, 5, 4}},  {kBack, {3, 2, 6, 7}},
                                           {kBottom, {2, 3, 1, 0}}, {kTop, {4, 5, 7, 6}}};
  for (const FaceCorners& face : kFaces) {
    if ((open & face.face) == 0) {
      std::vector<Vector3> corners;
      for (const unsigned i : face.corners) {
        corners.push_back(corner[i]);
      }
      const Vector3 first = corners[1] - corners[0];
      const Vector3 second = corners[2] - corners[1];
      addPolygon(corners, first.norm() >= second.norm() ? first : second, material);
    }
  }
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned axis = 1; axis < 8; axis *= 2) {
      if ((i & axis) == 0) {
        addEdge(corner[i], corner[i | axis]);
      }
    }
  }
}

void SceneBuilder::addFrame(const FrameShape& shape, const Material& material) {
  const Vector3 n = shape.u.cross(shape.v);
  const auto rectangle = [&](double inset) -> std::array<Vector3, 4> {
    const Vector3 low = shape.origin + inset * (shape.u + shape.v);
    const Vector3 across = (shape.width - 2 * inset) * shape.u;
    const Vector3 up = (shape.height - 2 * inset) * shape.v;
    return {low, low + across, low + across + up, low + up};
  };
  const std::array<Vector3, 4> outer = rectangle(0);
  const std::array<Vector3, 4> inner = rectangle(shape.border);
  const Vector3 front = shape.depth * n;
  const Vector3 inside = shape.inner_depth * n;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    const Vector3 along = outer[k] - outer[i];
    addPolygon({outer[i] + front, outer[k] + front, inner[k] + front, inner[i] + front}, along,
               material);
    addEdge(outer[i] + front, outer[k] + front);
    addEdge(inner[i] + front, inner[k] + front);
    if (shape.depth > 0) {
      addPolygon({outer[i], outer[k], outer[k] + front, outer[i] + front}, along, material);
      addEdge(outer[i], outer[k]);
      addEdge(outer[i], outer[i] + front);
    }
    if (shape.depth > shape.inner_depth) {
      addPolygon({inner[k] + inside, inner[i] + inside, inner[i] + front, inner[k] + front}, -along,
                 material);
      addEdge(inner[i] + inside, inner[k] + inside);
      addEdge(inner[i] + inside, inner[i] + front);
    }
  }
}

Scene SceneBuilder::build() {
  scene_.edges = uniteCollinear(std::move(scene_.edges));
  return std::move(scene_);
}

}  // namespace evolin::synthetic
