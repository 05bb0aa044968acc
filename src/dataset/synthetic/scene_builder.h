// Puts a scene together from boxes and frames and keeps account of their physical edges.
#pragma once

#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"

namespace evolin::synthetic {

/// A frame of reference that stands upright in the room: local x to the right, y to the back and z
/// up for somebody who looks at the front of what is placed. `yaw` turns counter-clockwise seen
/// from above, radians.
struct Placement {
  Vector3 origin = Vector3::Zero();
  double yaw = 0;

  Vector3 direction(const Vector3& local) const;
  Vector3 point(const Vector3& local) const { return origin + direction(local); }
};

/// Faces of a box in its placement.
enum Face : unsigned {
  kLeft = 1U,
  kRight = 2U,
  kFront = 4U,
  kBack = 8U,
  kBottom = 16U,
  kTop = 32U,
};

/// A flat ring between an outer and an inner rectangle that stands out of a plane.
struct FrameShape {
  Vector3 origin = Vector3::Zero();  ///< a corner of the outer rectangle, in the plane
  Vector3 u = Vector3::UnitX();
  Vector3 v = Vector3::UnitY();
  double width = 0;        ///< outer size along u
  double height = 0;       ///< outer size along v
  double border = 0;       ///< from the outer to the inner rectangle
  double depth = 0;        ///< height over the plane, along u x v
  double inner_depth = 0;  ///< where the inner sides end, over the plane
};

class SceneBuilder {
 public:
  explicit SceneBuilder(const Vector3& room_size) { scene_.size = room_size; }

  /// What is added from here on belongs to one object.
  void beginObject();

  /// A convex polygon, counter-clockwise seen from its front, with the texture's u along `u`; no
  /// edges.
  void addPolygon(const std::vector<Vector3>& corners, const Vector3& u, const Material& material);

  /// Several convex polygons of one plane under one texture; no edges.
  void addPieces(const std::vector<std::vector<Vector3>>& pieces, const Vector3& u,
                 const Material& material);

  /// The part above the floor.
  void addEdge(const Vector3& from, const Vector3& to);

  /// All 12 edges, and the faces but those in `open` (a sum of Face); `low` is the corner of
  /// smallest local coordinates. Textures run along the longer side of each face.
  void addBox(const Placement& placement, const Vector3& low, const Vector3& size,
              const Material& material, unsigned open = 0);

  /// Front, outer and inner sides, and their 24 edges; a flat ring (no depth) has no sides and 8.
  void addFrame(const FrameShape& shape, const Material& material);

  void addLight(const AreaLight& light) { scene_.lights.push_back(light); }

  /// The scene; edges that run into each other along one line become one.
  Scene build();

 private:
  Scene scene_;
};

}  // namespace evolin::synthetic
