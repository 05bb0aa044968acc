// Desk, chair, bookcase, sideboard, low table, lamp and rug.
#include "furniture.h"

#include <array>
#include <vector>

namespace evolin::synthetic {

namespace {

Color jittered(const Color& color, double amount, RandomStream* random) {
  return (color + Color(random->uniform(-amount, amount), random->uniform(-amount, amount),
                        random->uniform(-amount, amount)))
      .max(0.03)
      .min(0.95);
}

Material plain(const Color& color, std::uint64_t seed = 1) {
  return {Pattern::kPlain, color, color, seed, 0};
}

/// Four legs under a plate of width x depth, inset from its rim; the front is at -depth.
void addLegs(const Placement& place, double width, double depth, double inset, double thickness,
             double height, const Material& material, SceneBuilder* scene) {
  for (const double x : {inset, width - inset - thickness}) {
    for (const double y : {-depth + inset, -inset - thickness}) {
      scene->addBox(place, {x, y, 0}, {thickness, thickness, height}, material, kTop | kBottom);
    }
  }
}

/// Books side by side on a board at `low`, spines in one plane, until `width` is used up.
void addBookRow(const Placement& place, const Vector3& low, double width, double depth,
                double highest, RandomStream* random, SceneBuilder* scene) {
  static const std::array<Color, 9> kCovers = {
      Color(0.45, 0.09, 0.08), Color(0.10, 0.17, 0.34), Color(0.13, 0.27, 0.16),
      Color(0.62, 0.52, 0.33), Color(0.24, 0.14, 0.09), Color(0.68, 0.66, 0.60),
      Color(0.70, 0.38, 0.10), Color(0.15, 0.15, 0.17), Color(0.34, 0.42, 0.47)};
  double x = 0;
  std::size_t last = kCovers.size();
  while (true) {
    const double thickness = random->uniform(0.042, 0.07);
    if (x + thickness > width) {
      return;
    }
    std::size_t cover = random->below(kCovers.size());
    cover = cover == last ? (cover + 1) % kCovers.size() : cover;  // neighbours differ
    last = cover;
    Material spine;
    spine.pattern = Pattern::kBookSpine;
    spine.base = jittered(kCovers[cover], 0.04, random);
    spine.accent = spine.base.mean() < 0.35 ? Color(0.75, 0.66, 0.42) : Color(0.18, 0.13, 0.12);
    spine.seed = random->bits();
    scene->addBox(place, low + Vector3(x, 0, 0),
                  {thickness, depth, highest * random->uniform(0.72, 0.99)}, spine,
                  kBottom | kBack);
    x += thickness;
  }
}

/// Books lying on each other, each turned a little.
void addBookPile(const Placement& place, const Vector3& centre, int count, RandomStream* random,
                 SceneBuilder* scene) {
  double z = centre.z();
  for (int i = 0; i < count; ++i) {
    const double width = random->uniform(0.2, 0.27) - 0.015 * i;
    const double depth = width * random->uniform(0.68, 0.76);
    const double thickness = random->uniform(0.022, 0.04);
    Placement own;
    own.yaw = place.yaw + random->uniform(-0.5, 0.5);
    own.origin = place.point({centre.x(), centre.y(), z});
    const Color color(random->uniform(0.1, 0.7), random->uniform(0.1, 0.5),
                      random->uniform(0.1, 0.5));
    scene->addBox(own, {-width / 2, -depth / 2, 0}, {width, depth, thickness},
                  plain(color, random->bits()), kBottom);
    z += thickness;
  }
}

}  // namespace

Palette makePalette(RandomStream* random) {
  const std::array<Color, 4> walls = {Color(0.72, 0.70, 0.63), Color(0.66, 0.71, 0.70),
                                      Color(0.74, 0.68, 0.62), Color(0.67, 0.70, 0.62)};
  const std::array<Color, 4> features = {Color(0.48, 0.58, 0.60), Color(0.62, 0.55, 0.42),
                                         Color(0.50, 0.58, 0.47), Color(0.60, 0.47, 0.44)};
  const std::array<Color, 3> woods = {Color(0.58, 0.40, 0.24), Color(0.50, 0.31, 0.18),
                                      Color(0.66, 0.50, 0.33)};
  const std::array<Color, 4> fabrics = {Color(0.52, 0.20, 0.17), Color(0.19, 0.30, 0.43),
                                        Color(0.55, 0.45, 0.22), Color(0.22, 0.36, 0.30)};
  const auto make = [random](Pattern pattern, const Color& base, const Color& accent) {
    return Material{pattern, jittered(base, 0.03, random), accent, random->bits(), 0};
  };
  Palette palette;
  const Color& feature = features[random->below(features.size())];
  palette.wall = make(Pattern::kPlaster, walls[random->below(walls.size())], Color(0, 0, 0));
  palette.feature_wall = make(Pattern::kWallpaper, feature, feature * 1.25);
  palette.ceiling = make(Pattern::kPlaster, Color(0.82, 0.82, 0.80), Color(0, 0, 0));
  const Color& wood = woods[random->below(woods.size())];
  palette.floor = make(Pattern::kPlanks, Color(0.50, 0.36, 0.23), Color(0.36, 0.24, 0.14));
  palette.trim = make(Pattern::kPlain, Color(0.84, 0.83, 0.79), Color(0, 0, 0));
  palette.wood = make(Pattern::kWood, wood, wood * 0.62);
  palette.dark_wood = make(Pattern::kWood, wood * 0.42, wood * 0.25);
  const std::size_t fabric = random->below(fabrics.size());
  palette.fabric = make(Pattern::kWeave, fabrics[fabric], fabrics[fabric] * 0.6);
  palette.curtain = make(Pattern::kWeave, Color(0.72, 0.64, 0.50), Color(0.60, 0.50, 0.38));
  palette.metal = make(Pattern::kPlain, Color(0.30, 0.31, 0.33), Color(0, 0, 0));
  palette.rug =
      make(Pattern::kRug, fabrics[(fabric + 1) % fabrics.size()] * 0.9, Color(0.70, 0.62, 0.48));
  return palette;
}

Material varied(Material material, RandomStream* random) {
  material.seed = random->bits();
  return material;
}

void addDesk(const Placement& place, const Palette& palette, RandomStream* random,
             SceneBuilder* scene) {
  constexpr double kWidth = 1.55;
  constexpr double kDepth = 0.68;
  constexpr double kTopZ = 0.72;
  constexpr double kPlate = 0.03;
  scene->beginObject();
  const Material wood = varied(palette.wood, random);
  scene->addBox(place, {0, -kDepth, kTopZ}, {kWidth, kDepth, kPlate}, wood);
  addLegs(place, kWidth, kDepth, 0.03, 0.055, kTopZ, varied(palette.wood, random), scene);
  // A drawer block under the right half.
  scene->addBox(place, {1.02, -kDepth + 0.12, 0.3}, {0.38, 0.5, kTopZ - 0.3},
                varied(palette.wood, random), kTop);
  for (const double z : {0.315, 0.515}) {
    scene->addBox(place, {1.035, -kDepth + 0.105, z}, {0.35, 0.015, 0.185},
                  varied(palette.wood, random), kBack);
    scene->addBox(place, {1.195, -kDepth + 0.08, z + 0.08}, {0.03, 0.025, 0.03}, palette.metal,
                  kBack);
  }
  const double desk = kTopZ + kPlate;
  scene->beginObject();  // a monitor
  const double turn = random->uniform(-0.25, 0.25);
  Placement monitor{place.point({random->uniform(0.6, 0.72), -0.26, desk}), place.yaw + turn};
  const Material black = plain(Color(0.05, 0.05, 0.055), 5);
  scene->addBox(monitor, {-0.12, -0.09, 0}, {0.24, 0.17, 0.015}, black, kBottom);
  scene->addBox(monitor, {-0.025, 0.01, 0.015}, {0.05, 0.03, 0.16}, black, kBottom);
  scene->addBox(monitor, {-0.26, -0.02, 0.09}, {0.52, 0.035, 0.33}, black, kFront);
  const Vector3 x = monitor.direction(Vector3::UnitX());
  FrameShape bezel;
  bezel.origin = monitor.point({-0.26, -0.02, 0.09});
  bezel.u = x;
  bezel.v = Vector3::UnitZ();
  bezel.width = 0.52;
  bezel.height = 0.33;
  bezel.border = 0.018;
  scene->addFrame(bezel, black);
  const Vector3 low = bezel.origin + bezel.border * (x + Vector3::UnitZ());
  const Vector3 across = (bezel.width - 2 * bezel.border) * x;
  const Vector3 up = (bezel.height - 2 * bezel.border) * Vector3::UnitZ();
  const Material screen{Pattern::kScreen, Color(0.08, 0.16, 0.30), Color(0.35, 0.52, 0.66),
                        random->bits(), 0.55};
  scene->addPolygon({low, low + across, low + across + up, low + up}, x, screen);
  scene->beginObject();  // what lies about
  addBookPile(place, {1.3, -0.3, desk}, 1, random, scene);
  Placement paper{place.point({0.22, -0.42, desk}), place.yaw + random->uniform(0.1, 0.4)};
  scene->addBox(paper, {-0.105, -0.15, 0}, {0.21, 0.3, 0.012}, plain(Color(0.85, 0.85, 0.82), 8),
                kBottom);
}

void addChair(const Placement& place, const Palette& palette, RandomStream* random,
              SceneBuilder* scene) {
  constexpr double kSide = 0.44;
  constexpr double kSeat = 0.45;
  scene->beginObject();
  const Material wood = varied(palette.dark_wood, random);
  scene->addBox(place, {0, -kSide, kSeat - 0.05}, {kSide, kSide, 0.05}, palette.fabric);
  addLegs(place, kSide, kSide, 0.012, 0.04, kSeat - 0.05, wood, scene);
  for (const double x : {0.012, kSide - 0.052}) {
    scene->addBox(place, {x, -0.042, kSeat}, {0.04, 0.03, 0.47}, wood, kBottom);
  }
  scene->addBox(place, {0.052, -0.037, kSeat + 0.2}, {kSide - 0.104, 0.02, 0.24}, wood,
                kLeft | kRight);
}

void addBookcase(const Placement& place, const Palette& palette, RandomStream* random,
                 SceneBuilder* scene) {
  constexpr double kWidth = 1.05;
  constexpr double kHeight = 2.0;
  constexpr double kDepth = 0.3;
  constexpr double kPanel = 0.032;
  constexpr double kBoard = 0.025;
  constexpr int kShelves = 4;
  scene->beginObject();
  const Vector3 x = place.direction(Vector3::UnitX());
  FrameShape body;
  body.origin = place.origin;
  body.u = x;
  body.v = Vector3::UnitZ();
  body.width = kWidth;
  body.height = kHeight;
  body.border = kPanel;
  body.depth = kDepth;
  body.inner_depth = 0.01;
  scene->addFrame(body, varied(palette.wood, random));
  const double inner = kWidth - 2 * kPanel;
  const auto back = [&](double across, double up) {
    return place.point({kPanel + across, -0.01, kPanel + up});
  };
  const double inner_height = kHeight - 2 * kPanel;
  Material panel = varied(palette.wood, random);
  panel.base *= 0.8;
  scene->addPolygon({back(0, 0), back(inner, 0), back(inner, inner_height), back(0, inner_height)},
                    Vector3::UnitZ(), panel);
  const double pitch = inner_height / kShelves;
  for (int i = 1; i < kShelves; ++i) {
    scene->addBox(place, {kPanel, -kDepth + 0.015, kPanel + i * pitch - kBoard},
                  {inner, kDepth - 0.025, kBoard}, varied(palette.wood, random),
                  kLeft | kRight | kBack);
  }
  for (int i = 0; i < kShelves; ++i) {
    scene->beginObject();
    const Vector3 low(kPanel + 0.001, -kDepth + 0.05 + random->uniform(0.0, 0.03),
                      kPanel + i * pitch);
    const double clear = pitch - kBoard;
    if (i % 2 == 1) {  // boxes instead of books
      scene->addBox(place, low + Vector3(random->uniform(0.1, 0.45), 0, 0),
                    {random->uniform(0.36, 0.42), 0.2, 0.62 * clear},
                    varied(i == 1 ? palette.curtain : palette.fabric, random), kBottom);
    } else {
      const double start = random->uniform(0.0, 0.35);
      addBookRow(place, low + Vector3(start * inner, 0, 0), 0.4 * inner, 0.17, 0.75 * clear, random,
                 scene);
    }
  }
}

void addSideboard(const Placement& place, const Palette& palette, RandomStream* random,
                  SceneBuilder* scene) {
  constexpr double kWidth = 1.5;
  constexpr double kHeight = 0.78;
  constexpr double kDepth = 0.42;
  constexpr double kLeg = 0.12;
  constexpr int kDoors = 2;
  scene->beginObject();
  scene->addBox(place, {0.02, -kDepth, kLeg}, {kWidth - 0.04, kDepth - 0.01, kHeight - kLeg - 0.03},
                varied(palette.wood, random), kTop);
  scene->addBox(place, {0, -kDepth - 0.025, kHeight - 0.03}, {kWidth, kDepth + 0.025, 0.03},
                varied(palette.dark_wood, random));
  addLegs(place, kWidth, kDepth, 0.06, 0.05, kLeg, palette.dark_wood, scene);
  const double pitch = (kWidth - 0.08) / kDoors;
  for (int i = 0; i < kDoors; ++i) {
    const double x = 0.04 + i * pitch;
    scene->addBox(place, {x + 0.008, -kDepth - 0.018, kLeg + 0.025},
                  {pitch - 0.016, 0.018, kHeight - kLeg - 0.085}, varied(palette.wood, random),
                  kBack);
    const double knob = i == 0 ? x + pitch - 0.07 : x + 0.04;
    scene->addBox(place, {knob, -kDepth - 0.043, 0.52}, {0.03, 0.025, 0.03}, palette.metal, kBack);
  }
  scene->beginObject();
  Placement box{place.point({random->uniform(0.3, 1.2), -0.2, kHeight}),
                place.yaw + random->uniform(-0.3, 0.3)};
  scene->addBox(box, {-0.14, -0.09, 0}, {0.28, 0.18, 0.15}, varied(palette.fabric, random),
                kBottom);
}

void addCoffeeTable(const Placement& place, const Palette& palette, RandomStream* random,
                    SceneBuilder* scene) {
  constexpr double kWidth = 0.95;
  constexpr double kDepth = 0.52;
  constexpr double kHeight = 0.4;
  scene->beginObject();
  scene->addBox(place, {0, -kDepth, kHeight - 0.03}, {kWidth, kDepth, 0.03},
                varied(palette.wood, random));
  addLegs(place, kWidth, kDepth, 0.025, 0.05, kHeight - 0.03, varied(palette.wood, random), scene);
  scene->beginObject();
  addBookPile(place, {random->uniform(0.25, 0.35), -0.26, kHeight}, 2, random, scene);
}

void addFloorLamp(const Placement& place, const Palette& palette, SceneBuilder* scene) {
  constexpr double kFoot = 1.32;  // height of the shade's lower rim
  constexpr double kRim = 1.62;
  scene->beginObject();
  scene->addBox(place, {-0.14, -0.14, 0}, {0.28, 0.28, 0.03}, palette.metal, kBottom);
  scene->addBox(place, {-0.013, -0.013, 0.03}, {0.026, 0.026, kRim - 0.06}, palette.metal, kBottom);
  const auto square = [&](double half, double z) -> std::array<Vector3, 4> {
    return {place.point({-half, -half, z}), place.point({half, -half, z}),
            place.point({half, half, z}), place.point({-half, half, z})};
  };
  const std::array<Vector3, 4> low = square(0.21, kFoot);
  const std::array<Vector3, 4> high = square(0.13, kRim);
  Material shade = plain(Color(0.80, 0.70, 0.50), 4);
  shade.pattern = Pattern::kWeave;
  shade.accent = Color(0.7, 0.58, 0.38);
  shade.glow = 0.55;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    const Vector3 along = low[k] - low[i];
    scene->addPolygon({low[i], low[k], high[k], high[i]}, along, shade);
    scene->addPolygon({low[k], low[i], high[i], high[k]}, -along, shade);  // its inside
    scene->addEdge(low[i], low[k]);
    scene->addEdge(high[i], high[k]);
    scene->addEdge(low[i], high[i]);
  }
}

void addRug(const Placement& place, double width, double depth, const Palette& palette,
            SceneBuilder* scene) {
  constexpr double kThickness = 0.002;  // seen as none
  scene->beginObject();
  const std::array<Vector3, 4> corners = {place.point({-width / 2, -depth / 2, kThickness}),
                                          place.point({width / 2, -depth / 2, kThickness}),
                                          place.point({width / 2, depth / 2, kThickness}),
                                          place.point({-width / 2, depth / 2, kThickness})};
  scene->addPolygon({corners.begin(), corners.end()}, place.direction(Vector3::UnitX()),
                    palette.rug);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    scene->addEdge(corners[i], corners[(i + 1) % corners.size()]);
  }
}

}  // namespace evolin::synthetic
