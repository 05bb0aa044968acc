// A furnished room as flat textured surfaces, and its physical edges as segments in space.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evolin::synthetic {

/// Metres; x east, y north, z up; a corner of the floor is the origin.
using Vector3 = Eigen::Vector3d;

/// Red, green, blue; as reflectance 1 is a white that swallows nothing.
using Color = Eigen::Array3d;

enum class Pattern {
  kPlain,
  kPlaster,
  kWallpaper,
  kWood,    ///< grain along the patch's u
  kPlanks,  ///< floor boards along u
  kWeave,
  kRug,
  kBookSpine,
  kPicture,
  kSky,
  kScreen
};

struct Material {
  Pattern pattern = Pattern::kPlain;
  Color base = Color(0.5, 0.5, 0.5);
  Color accent = Color(0.3, 0.3, 0.3);  ///< second colour of patterns that have two
  std::uint64_t seed = 0;               ///< two surfaces with different seeds look different
  double glow = 0;                      ///< light of its own, in units of a well-lit white wall
};

/// The rectangle that a texture covers: origin + a u + b v with 0 <= a <= width, 0 <= b <= height
/// (metres; u and v are of unit length and at right angles). It is seen from the side of u x v.
struct Patch {
  Vector3 origin = Vector3::Zero();
  Vector3 u = Vector3::UnitX();
  Vector3 v = Vector3::UnitY();
  double width = 0;
  double height = 0;
  Material material;

  Vector3 normal() const { return u.cross(v); }
};

/// A convex polygon in the plane of its patch, counter-clockwise as seen from the patch's front;
/// from behind it is invisible. Several surfaces may share one patch.
struct Surface {
  std::size_t patch = 0;
  std::vector<Vector3> corners;
};

/// Surfaces [first, last) belong to one object.
struct Object {
  std::size_t first = 0;
  std::size_t last = 0;
  Eigen::AlignedBox3d bounds;
};

/// A straight line where two faces of different direction or of two objects meet. Where surfaces
/// of one colour lie in one plane there is no edge; pattern on a surface makes none either.
struct Edge {
  Vector3 from = Vector3::Zero();
  Vector3 to = Vector3::Zero();
};

/// A rectangle origin + a u + b v with a, b in [0, 1] (metres) that shines to the side of `normal`.
struct AreaLight {
  Vector3 origin = Vector3::Zero();
  Vector3 u = Vector3::UnitX();
  Vector3 v = Vector3::UnitY();
  Vector3 normal = Vector3::UnitZ();
  Color power = Color(1, 1, 1);  ///< light on a white surface at 1 m, facing it
};

struct Scene {
  Vector3 size = Vector3::Zero();  ///< of the room
  std::vector<Patch> patches;
  std::vector<Surface> surfaces;
  std::vector<Object> objects;  ///< every surface is in one of them
  std::vector<Edge> edges;
  std::vector<AreaLight> lights;
};

/// A room with walls, window, door, desk, chair, bookcase, sideboard, pictures and lamps. `seed`
/// varies colours, patterns, the books, and places by some centimetres. At least 120 edges.
Scene makeRoom(std::uint64_t seed);

}  // namespace evolin::synthetic
