// Patterns are functions of the place on the patch, made of lattice noise and a few waves.
#include "patterns.h"

#include <algorithm>
#include <cmath>

#include "counter_random.h"

namespace evolin::synthetic {

namespace {

constexpr double kTwoPi = 6.283185307179586;

double fade(double t) { return t * t * (3 - 2 * t); }

double smoothStep(double low, double high, double value) {
  return fade(std::clamp((value - low) / (high - low), 0.0, 1.0));
}

Color mix(const Color& a, const Color& b, double share) { return a + (b - a) * share; }

double latticeValue(std::uint64_t seed, std::int64_t x, std::int64_t y) {
  return unitInterval(mixBits(seed, (static_cast<std::uint64_t>(x) << 32U) ^
                                        (static_cast<std::uint64_t>(y) & 0xFFFFFFFFU)));
}

/// Smooth in [0, 1] with features of size 1.
double noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx);
  const auto iy = static_cast<std::int64_t>(fy);
  const double sx = fade(x - fx);
  const double sy = fade(y - fy);
  const double low = latticeValue(seed, ix, iy) * (1 - sx) + latticeValue(seed, ix + 1, iy) * sx;
  const double high =
      latticeValue(seed, ix, iy + 1) * (1 - sx) + latticeValue(seed, ix + 1, iy + 1) * sx;
  return low * (1 - sy) + high * sy;
}

/// In [-1, 1], features of size 1 down to 1 / 2^(octaves - 1).
double turbulence(std::uint64_t seed, double x, double y, int octaves) {
  double sum = 0;
  double weight = 0.5;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * (2 * noise(seed + static_cast<std::uint64_t>(octave), x, y) - 1);
    weight /= 2;
    x *= 2;
    y *= 2;
  }
  return sum;
}

double plaster(std::uint64_t seed, double u, double v) {
  return 1 + 0.035 * turbulence(seed, u * 2.5, v * 2.5, 3) +
         0.025 * turbulence(seed + 9, u * 60, v * 60, 2);
}

Color wallpaper(const Material& m, double u, double v) {
  constexpr double kRepeat = 0.16;
  const double a = kTwoPi * u / kRepeat;
  const double b = kTwoPi * v / kRepeat;
  // Soft blossoms on a diamond lattice, every second one small.
  const double blossom = std::cos(a) * std::cos(b) + 0.35 * std::cos(2 * a) * std::cos(2 * b) +
                         0.25 * std::cos(a / 2) * std::cos(b / 2);
  return mix(m.base, m.accent, 0.55 * smoothStep(0.25, 1.1, blossom)) * plaster(m.seed, u, v);
}

Color wood(const Material& m, double u, double v) {
  const double bend = turbulence(m.seed, u * 1.1, v * 5, 3);
  const double rings = 0.5 + 0.5 * std::sin(kTwoPi * (v * 11 + 1.6 * bend));
  const double fibres = noise(m.seed + 5, u * 9, v * 260);
  return mix(m.base, m.accent, 0.42 * rings * (0.6 + 0.4 * fibres)) *
         (0.96 + 0.05 * fibres + 0.05 * bend);
}

Color planks(const Material& m, double u, double v) {
  constexpr double kWidth = 0.13;
  constexpr double kLength = 1.3;
  const double row = std::floor(v / kWidth);
  const double shift = latticeValue(m.seed, static_cast<std::int64_t>(row), 7) * kLength;
  const double column = std::floor((u + shift) / kLength);
  const std::uint64_t board = mixBits(mixBits(m.seed, static_cast<std::uint64_t>(row + 1000)),
                                      static_cast<std::uint64_t>(column + 1000));
  Material own = m;
  own.seed = board;
  const double across = v - row * kWidth;
  const double along = u + shift - column * kLength;
  const double gap = std::min({across, kWidth - across, along, kLength - along});
  return wood(own, u, v) * (0.9 + 0.2 * unitInterval(board)) *
         (0.8 + 0.2 * smoothStep(0.0005, 0.004, gap));
}

Color weave(const Material& m, double u, double v) {
  const double threads = std::sin(kTwoPi * u / 0.009) * std::sin(kTwoPi * v / 0.009);
  return mix(m.base, m.accent, 0.12 + 0.1 * threads) *
         (1 + 0.08 * turbulence(m.seed, u * 9, v * 9, 4));
}

Color rug(const Material& m, double u, double v, double width, double height) {
  const double rim = std::min({u, width - u, v, height - v});
  const double x = (u - width / 2) / 0.24;
  const double y = (v - height / 2) / 0.24;
  const double diamond = std::abs(x - std::round(x)) + std::abs(y - std::round(y));
  double share = 0.7 * smoothStep(0.24, 0.3, diamond) * (1 - smoothStep(0.44, 0.5, diamond));
  const double band = smoothStep(0.045, 0.055, rim) * (1 - smoothStep(0.145, 0.155, rim));
  share = rim < 0.2 ? 0.95 * band : share;
  return mix(m.base, m.accent, share) * (1 + 0.16 * turbulence(m.seed, u * 70, v * 70, 2)) *
         (1 + 0.1 * turbulence(m.seed + 3, u * 3, v * 3, 3));
}

Color bookSpine(const Material& m, double u, double v, double width, double height) {
  const double along = u / width;
  const double across = v / height;
  double share = 0;
  for (const double place : {0.1, 0.86}) {
    const double place_here = place + 0.06 * (latticeValue(m.seed, 3, place > 0.5 ? 1 : 0) - 0.5);
    share = std::max(share, 1 - smoothStep(0.008, 0.02, std::abs(along - place_here)));
  }
  // Lettering without letters: blots in a row along the spine.
  const bool lettered = along > 0.24 && along < 0.74 && across > 0.3 && across < 0.7;
  if (lettered) {
    share = std::max(share, smoothStep(0.5, 0.6, noise(m.seed + 2, u * 160, v * 90)));
  }
  return mix(m.base, m.accent, 0.75 * share) * (1 + 0.06 * turbulence(m.seed, u * 40, v * 40, 2));
}

Color picture(const Material& m, double u, double v, double width, double height) {
  const double x = u / width;
  const double y = v / height;
  RandomStream random(m.seed);
  const Color dusk(random.uniform(0.7, 0.95), random.uniform(0.5, 0.75), random.uniform(0.35, 0.6));
  const Color zenith(random.uniform(0.2, 0.4), random.uniform(0.35, 0.55),
                     random.uniform(0.5, 0.8));
  Color color = mix(dusk, zenith, smoothStep(0.3, 1.0, y));
  const double sun_x = random.uniform(0.2, 0.8);
  const double sun_y = random.uniform(0.6, 0.8);
  const double aspect = width / height;
  const double sun = std::hypot((x - sun_x) * aspect, y - sun_y);
  color = mix(color, Color(0.98, 0.93, 0.75), 1 - smoothStep(0.06, 0.09, sun));
  for (int range = 0; range < 4; ++range) {
    const double distance = 1 - range / 3.0;
    const double crest = 0.14 + 0.4 * distance +
                         0.22 * turbulence(m.seed + 11 * static_cast<std::uint64_t>(range) + 1,
                                           x * (1.5 + range) * aspect + 3, 0.5, 4);
    const Color hill = mix(m.base, m.accent, 0.85 * distance) * (1 - 0.12 * range);
    color = mix(color, hill, 1 - smoothStep(crest - 0.012, crest + 0.012, y));
  }
  return color * (1 + 0.1 * turbulence(m.seed + 77, u * 45, v * 45, 3));
}

Color sky(const Material& m, double u, double v, double width, double height) {
  const double y = v / height;
  Color color = mix(m.accent, m.base, smoothStep(0.2, 1.0, y));
  const double cloud = turbulence(m.seed, u * 2.2, v * 5, 5);
  color = mix(color, Color(0.97, 0.97, 0.97), 0.8 * smoothStep(0.05, 0.45, cloud));
  const double trees = 0.25 + 0.16 * turbulence(m.seed + 21, u * 3.5 / width * 2, 0.3, 5);
  const double leaves = 0.5 + 0.5 * turbulence(m.seed + 31, u * 30, v * 30, 4);
  return mix(color, Color(0.22, 0.34, 0.16) * (0.6 + 0.8 * leaves),
             1 - smoothStep(trees - 0.03, trees + 0.03, y));
}

Color screen(const Material& m, double u, double v, double width, double height) {
  const double x = u / width;
  const double y = v / height;
  return mix(m.base, m.accent, smoothStep(0.0, 1.3, y + 0.5 * x)) *
         (1 + 0.5 * turbulence(m.seed, x * 2.5, y * 2.5, 2));
}

}  // namespace

Color reflectance(const Material& m, double u, double v, double width, double height) {
  switch (m.pattern) {
    case Pattern::kPlain:
      return m.base * (1 + 0.02 * turbulence(m.seed, u * 50, v * 50, 2));
    case Pattern::kPlaster:
      return m.base * plaster(m.seed, u, v);
    case Pattern::kWallpaper:
      return wallpaper(m, u, v);
    case Pattern::kWood:
      return wood(m, u, v);
    case Pattern::kPlanks:
      return planks(m, u, v);
    case Pattern::kWeave:
      return weave(m, u, v);
    case Pattern::kRug:
      return rug(m, u, v, width, height);
    case Pattern::kBookSpine:
      return bookSpine(m, u, v, width, height);
    case Pattern::kPicture:
      return picture(m, u, v, width, height);
    case Pattern::kSky:
      return sky(m, u, v, width, height);
    case Pattern::kScreen:
      return screen(m, u, v, width, height);
  }
  return m.base;
}

}  // namespace evolin::synthetic
