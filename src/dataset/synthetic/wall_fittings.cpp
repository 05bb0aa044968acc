// What is fixed to walls: pictures, the door, the window and its curtains.
#include <cmath>
#include <vector>

#include "furniture.h"

namespace evolin::synthetic {

namespace {

/// A frame in a wall's plane (local y = `back`), standing out towards the room.
FrameShape wallFrame(const Placement& place, const Opening& outer, double back, double border,
                     double depth, double inner_depth) {
  FrameShape shape;
  shape.origin = place.point({outer.left, back, outer.bottom});
  shape.u = place.direction(Vector3::UnitX());
  shape.v = Vector3::UnitZ();
  shape.width = outer.right - outer.left;
  shape.height = outer.top - outer.bottom;
  shape.border = border;
  shape.depth = depth;
  shape.inner_depth = inner_depth;
  return shape;
}

void addSheet(const Placement& place, const Opening& area, double y, const Material& material,
              SceneBuilder* scene) {
  scene->addPolygon(
      {place.point({area.left, y, area.bottom}), place.point({area.right, y, area.bottom}),
       place.point({area.right, y, area.top}), place.point({area.left, y, area.top})},
      place.direction(Vector3::UnitX()), material);
}

}  // namespace

void addPicture(const Placement& place, const Vector3& low, double width, double height,
                const Palette& palette, RandomStream* random, SceneBuilder* scene) {
  constexpr double kBorder = 0.035;
  scene->beginObject();
  const Opening outer{low.x(), low.z(), low.x() + width, low.z() + height};
  const bool light = random->below(3) == 0;
  constexpr double kDepth = 0.024;
  scene->addFrame(wallFrame(place, outer, 0, kBorder, kDepth, kDepth),
                  light ? palette.trim : varied(palette.dark_wood, random));
  Material art;
  art.pattern = Pattern::kPicture;
  art.base =
      Color(random->uniform(0.05, 0.3), random->uniform(0.1, 0.3), random->uniform(0.1, 0.25));
  art.accent =
      Color(random->uniform(0.4, 0.7), random->uniform(0.4, 0.6), random->uniform(0.4, 0.75));
  art.seed = random->bits();
  addSheet(
      place,
      {outer.left + kBorder, outer.bottom + kBorder, outer.right - kBorder, outer.top - kBorder},
      -kDepth, art, scene);
}

void addDoor(const Placement& place, const Palette& palette, RandomStream* random,
             SceneBuilder* scene) {
  constexpr double kWidth = 0.98;
  constexpr double kHeight = 2.12;
  constexpr double kCasing = 0.085;
  constexpr double kCasingDepth = 0.045;
  scene->beginObject();
  // The casing's lower border would lie under the floor; only its end faces show.
  scene->addFrame(wallFrame(place, {0, -kCasing, kWidth, kHeight}, 0, kCasing, kCasingDepth, 0),
                  palette.trim);
  for (const double x : {0.0, kWidth - kCasing}) {
    scene->addEdge(place.point({x, -kCasingDepth, 0}),
                   place.point({x + kCasing, -kCasingDepth, 0}));
    for (const double side : {x, x + kCasing}) {
      scene->addEdge(place.point({side, 0, 0}), place.point({side, -kCasingDepth, 0}));
    }
  }
  const double leaf = kWidth - 2 * kCasing;
  Material paint = varied(palette.trim, random);
  paint.base *= 0.92;
  scene->addBox(place, {kCasing, -0.024, 0.006}, {leaf, 0.024, kHeight - kCasing - 0.012}, paint,
                kBack);
  Material panel = paint;
  panel.base *= 0.86;
  for (const auto& [bottom, top] : {std::pair(0.16, 0.84), std::pair(1.08, 1.88)}) {
    scene->addBox(place, {kCasing + 0.13, -0.042, bottom}, {leaf - 0.26, 0.018, top - bottom},
                  panel, kBack);
  }
  scene->addBox(place, {kCasing + 0.04, -0.034, 0.93}, {0.045, 0.01, 0.045}, palette.metal, kBack);
  scene->addBox(place, {kCasing + 0.05, -0.078, 0.942}, {0.022, 0.044, 0.022}, palette.metal,
                kBack);
  scene->addBox(place, {kCasing + 0.072, -0.078, 0.944}, {0.1, 0.018, 0.018}, palette.metal, kLeft);
}

void addWindow(const Placement& place, const Opening& opening, const Palette& palette,
               RandomStream* random, SceneBuilder* scene) {
  constexpr double kReveal = 0.16;
  constexpr double kFrame = 0.055;
  scene->beginObject();
  const double left = opening.left;
  const double right = opening.right;
  const double bottom = opening.bottom;
  const double top = opening.top;
  const auto at = [&place](double x, double y, double z) { return place.point({x, y, z}); };
  const std::vector<Vector3> front = {at(left, 0, bottom), at(right, 0, bottom), at(right, 0, top),
                                      at(left, 0, top)};
  const std::vector<Vector3> back = {at(left, kReveal, bottom), at(right, kReveal, bottom),
                                     at(right, kReveal, top), at(left, kReveal, top)};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    scene->addPolygon({front[i], front[k], back[k], back[i]}, front[k] - front[i], palette.wall);
    scene->addEdge(front[i], front[k]);
    scene->addEdge(front[i], back[i]);
    scene->addEdge(back[i], back[k]);
  }
  // Two casements with a bar across each, flush with the panes.
  const double middle = (left + right) / 2;
  const double bar = bottom + 0.68 * (top - bottom);
  const double columns[] = {left + kFrame, middle - kFrame / 2, middle + kFrame / 2,
                            right - kFrame};
  const double rows[] = {bottom + kFrame, bar, bar + 0.04, top - kFrame};
  const auto rectangle = [&](double x0, double z0, double x1, double z1) {
    return std::vector<Vector3>{at(x0, kReveal, z0), at(x1, kReveal, z0), at(x1, kReveal, z1),
                                at(x0, kReveal, z1)};
  };
  std::vector<std::vector<Vector3>> bars = {rectangle(left, bottom, columns[0], top),
                                            rectangle(columns[1], bottom, columns[2], top),
                                            rectangle(columns[3], bottom, right, top)};
  std::vector<std::vector<Vector3>> panes;
  for (const int column : {0, 2}) {
    const double x0 = columns[column];
    const double x1 = columns[column + 1];
    bars.push_back(rectangle(x0, bottom, x1, rows[0]));
    bars.push_back(rectangle(x0, rows[1], x1, rows[2]));
    bars.push_back(rectangle(x0, rows[3], x1, top));
    for (const int row : {0, 2}) {
      const std::vector<Vector3> pane = rectangle(x0, rows[row], x1, rows[row + 1]);
      for (std::size_t i = 0; i < 4; ++i) {
        scene->addEdge(pane[i], pane[(i + 1) % 4]);
      }
      panes.push_back(pane);
    }
  }
  const Vector3 along = place.direction(Vector3::UnitX());
  scene->addPieces(bars, along, palette.trim);
  scene->addPieces(
      panes, along,
      {Pattern::kSky, Color(0.35, 0.52, 0.80), Color(0.80, 0.86, 0.90), random->bits(), 0.95});
  // The sill stands out into the room.
  scene->addBox(place, {left - 0.06, -0.075, bottom - 0.035}, {right - left + 0.12, 0.075, 0.035},
                palette.trim, kBack);

  AreaLight light;
  light.origin = at(left + kFrame, -0.02, bottom + kFrame);
  light.u = place.direction({right - left - 2 * kFrame, 0, 0});
  light.v = {0, 0, top - bottom - 2 * kFrame};
  light.normal = place.direction(-Vector3::UnitY());
  light.power = Color(2.3, 2.5, 2.8);
  scene->addLight(light);
}

void addCurtains(const Placement& place, const Opening& window, const Palette& palette,
                 RandomStream* random, SceneBuilder* scene) {
  constexpr int kFolds = 3;
  constexpr double kFold = 0.066;  // half a fold's width
  const double rod = window.top + 0.13;
  scene->beginObject();
  scene->addBox(place, {window.left - 0.42, -0.13, rod},
                {window.right - window.left + 0.84, 0.025, 0.025}, palette.metal);
  for (const double start : {window.left - 0.36, window.right - 0.06}) {
    scene->beginObject();
    const Material cloth = varied(palette.curtain, random);
    Vector3 last;
    for (int i = 0; i <= 2 * kFolds; ++i) {
      const double y = i % 2 == 0 ? -0.085 : -0.15 - random->uniform(0.0, 0.03);
      const Vector3 low = place.point({start + i * kFold, y, 0.07});
      const Vector3 up(0, 0, rod - 0.07 - 0.004);
      if (i > 0) {
        scene->addPolygon({last, low, low + up, last + up}, Vector3::UnitZ(), cloth);
        scene->addEdge(last, low);
        scene->addEdge(last + up, low + up);
      }
      scene->addEdge(low, low + up);
      last = low;
    }
  }
}

}  // namespace evolin::synthetic
