// The room's shell and where the furniture stands in it.
#include <cmath>

#include "furniture.h"

namespace evolin::synthetic {

namespace {

constexpr double kWidth = 5.2;   // x
constexpr double kLength = 4.4;  // y
constexpr double kHeight = 2.6;  // z
constexpr double kSkirting = 0.085;
constexpr double kQuarterTurn = 1.5707963267948966;

/// Walls as somebody sees them who stands before them: local x = 0 at the left end.
Placement northWall() { return {{0, kLength, 0}, 0}; }
Placement eastWall() { return {{kWidth, kLength, 0}, -kQuarterTurn}; }
Placement southWall() { return {{kWidth, 0, 0}, 2 * kQuarterTurn}; }
Placement westWall() { return {{0, 0, 0}, kQuarterTurn}; }

Placement shifted(const Placement& place, const Vector3& local, double turn = 0) {
  return {place.point(local), place.yaw + turn};
}

/// The rectangle of a wall from (left, bottom) to (right, top).
std::vector<Vector3> piece(const Placement& wall, double left, double bottom, double right,
                           double top) {
  return {wall.point({left, 0, bottom}), wall.point({right, 0, bottom}),
          wall.point({right, 0, top}), wall.point({left, 0, top})};
}

void addShell(const Opening& window, const Palette& palette, RandomStream* random,
              SceneBuilder* scene) {
  scene->beginObject();
  const Vector3 x = Vector3::UnitX();
  const Placement north = northWall();
  scene->addPieces({piece(north, 0, kSkirting, window.left, kHeight),
                    piece(north, window.right, kSkirting, kWidth, kHeight),
                    piece(north, window.left, kSkirting, window.right, window.bottom),
                    piece(north, window.left, window.top, window.right, kHeight)},
                   x, palette.feature_wall);
  for (const auto& [wall, width] : {std::pair(eastWall(), kLength), std::pair(southWall(), kWidth),
                                    std::pair(westWall(), kLength)}) {
    scene->addPolygon(piece(wall, 0, kSkirting, width, kHeight), wall.direction(x),
                      varied(palette.wall, random));
  }
  for (const auto& [wall, width] :
       {std::pair(north, kWidth), std::pair(eastWall(), kLength), std::pair(southWall(), kWidth),
        std::pair(westWall(), kLength)}) {
    // A skirting too thin for a face of its own on top.
    scene->addPolygon(piece(wall, 0, 0, width, kSkirting), wall.direction(x), palette.trim);
    for (const double z : {0.0, kSkirting, kHeight}) {
      scene->addEdge(wall.point({0, 0, z}), wall.point({width, 0, z}));
    }
    scene->addEdge(wall.point({0, 0, 0}), wall.point({0, 0, kHeight}));
  }
  scene->addPolygon({{0, 0, 0}, {kWidth, 0, 0}, {kWidth, kLength, 0}, {0, kLength, 0}}, x,
                    palette.floor);
  scene->addPolygon(
      {{0, kLength, kHeight}, {kWidth, kLength, kHeight}, {kWidth, 0, kHeight}, {0, 0, kHeight}}, x,
      palette.ceiling);
}

void addCeilingLamp(const Vector3& centre, const Palette& palette, SceneBuilder* scene) {
  constexpr double kSide = 0.62;
  constexpr double kDrop = 0.06;
  scene->beginObject();
  FrameShape rim;
  rim.origin = centre + Vector3(-kSide / 2, kSide / 2, 0);
  rim.v = -Vector3::UnitY();
  rim.width = kSide;
  rim.height = kSide;
  rim.border = 0.03;
  rim.depth = kDrop;
  rim.inner_depth = kDrop;
  scene->addFrame(rim, palette.metal);
  const double half = kSide / 2 - rim.border;
  const Vector3 low = centre - Vector3(0, 0, rim.inner_depth);
  const Material glowing{Pattern::kPlain, Color(0.95, 0.93, 0.86), Color(0, 0, 0), 3, 1.4};
  scene->addPolygon({low + Vector3(-half, half, 0), low + Vector3(half, half, 0),
                     low + Vector3(half, -half, 0), low + Vector3(-half, -half, 0)},
                    Vector3::UnitX(), glowing);
  AreaLight light;
  light.origin = centre + Vector3(-half, -half, -kDrop - 0.01);
  light.u = {2 * half, 0, 0};
  light.v = {0, 2 * half, 0};
  light.normal = -Vector3::UnitZ();
  light.power = Color(2.8, 2.6, 2.2);
  scene->addLight(light);
}

}  // namespace

Scene makeRoom(std::uint64_t seed) {
  RandomStream random(mixBits(seed, 0x726F6F6DU));
  const Palette palette = makePalette(&random);
  const auto about = [&random](double value, double by) { return value + random.uniform(-by, by); };
  SceneBuilder scene(Vector3(kWidth, kLength, kHeight));
  const Opening window{about(2.35, 0.06), 0.98, about(3.75, 0.06), 2.15};
  addShell(window, palette, &random, &scene);
  const Placement north = northWall();
  addWindow(north, window, palette, &random, &scene);
  addCurtains(north, window, palette, &random, &scene);
  addDoor(shifted(north, {about(0.42, 0.06), 0, 0}), palette, &random, &scene);
  addPicture(north, {about(1.52, 0.02), 0, about(1.3, 0.05)}, 0.38, 0.5, palette, &random, &scene);
  addDesk(shifted(north, {about(2.28, 0.06), -0.19, 0}), palette, &random, &scene);
  addChair(shifted(north, {about(2.75, 0.1), -1.0, 0}, about(3.6, 0.25)), palette, &random, &scene);
  addFloorLamp(shifted(north, {about(4.78, 0.03), -0.42, 0}, about(0.3, 0.1)), palette, &scene);

  const Placement east = eastWall();
  addBookcase(shifted(east, {about(0.85, 0.04), -0.004, 0}), palette, &random, &scene);
  addSideboard(shifted(east, {about(2.2, 0.08), -0.004, 0}), palette, &random, &scene);
  addPicture(east, {about(2.2, 0.05), 0, about(1.25, 0.05)}, 0.62, 0.48, palette, &random, &scene);
  addPicture(east, {about(3.0, 0.05), 0, about(1.2, 0.05)}, 0.42, 0.56, palette, &random, &scene);
  addPicture(east, {about(0.2, 0.03), 0, about(1.35, 0.05)}, 0.4, 0.4, palette, &random, &scene);

  const Placement middle{{about(3.15, 0.08), about(2.35, 0.08), 0}, about(0.12, 0.08)};
  addRug(middle, 2.1, 1.5, palette, &scene);
  addCoffeeTable(shifted(middle, {-0.4, 0.2, 0.002}, about(0.1, 0.1)), palette, &random, &scene);
  addPicture(westWall(), {about(1.6, 0.1), 0, 1.3}, 0.8, 0.6, palette, &random, &scene);
  addPicture(southWall(), {about(2.2, 0.1), 0, 1.3}, 0.7, 0.5, palette, &random, &scene);
  addCeilingLamp({kWidth / 2, kLength / 2, kHeight}, palette, &scene);
  return scene.build();
}

}  // namespace evolin::synthetic
