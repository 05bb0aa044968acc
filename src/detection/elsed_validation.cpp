// Validation of ELSED segments by the direction of their gradients.
#include "elsed_validation.h"

#include <algorithm>
#include <cmath>

namespace evolin::elsed {
namespace {

struct Gradient {
  float dx;
  float dy;
};

Gradient interpolated(const GradientMaps& maps, float x, float y) {
  x = std::clamp(x, 0.0F, static_cast<float>(maps.width - 1));
  y = std::clamp(y, 0.0F, static_cast<float>(maps.height - 1));
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const float right_share = x - static_cast<float>(left);
  const float bottom_share = y - static_cast<float>(top);
  const std::int16_t* a = maps.derivatives.data() + 2 * maps.at(left, top);
  const std::int16_t* b = left + 1 < maps.width ? a + 2 : a;
  const std::ptrdiff_t row =
      top + 1 < maps.height ? 2 * static_cast<std::ptrdiff_t>(maps.width) : 0;
  const auto mix = [&](int k) {
    const float above =
        static_cast<float>(a[k]) * (1 - right_share) + static_cast<float>(b[k]) * right_share;
    const float below = static_cast<float>(a[row + k]) * (1 - right_share) +
                        static_cast<float>(b[row + k]) * right_share;
    return above * (1 - bottom_share) + below * bottom_share;
  };
  return {mix(0), mix(1)};
}

}  // namespace

Verdict validate(const Drawing& drawing, const DrawnSegment& segment, const GradientMaps& maps,
                 double threshold) {
  const auto a = static_cast<float>(segment.line.a);
  const auto b = static_cast<float>(segment.line.b);
  const auto c = static_cast<float>(segment.line.c);
  const auto tangent = static_cast<float>(std::tan(threshold));
  // Gradients of nothing have the angle 0.
  const bool flat_agrees = std::abs(std::atan2(b, std::abs(a))) <= threshold;
  const int margin = static_cast<int>(std::min(5.0, 0.1 * static_cast<double>(segment.size)));
  const auto along = [&](EdgePixel p) { return segment.horizontal ? p.x : p.y; };
  const int low = std::min(along(segment.first), along(segment.last)) + margin;
  const int high = std::max(along(segment.first), along(segment.last)) - margin;

  Verdict verdict;
  for (std::size_t i = segment.begin; i < segment.end; ++i) {
    const EdgePixel p = drawing.pixels()[i];
    if (along(p) < low || along(p) > high || drawing.label(p) != Label::kInlier) {
      continue;
    }
    const auto x = static_cast<float>(p.x);
    const auto y = static_cast<float>(p.y);
    const float distance = a * x + b * y + c;
    const Gradient gradient = interpolated(maps, x - a * distance, y - b * distance);
    const float cross = std::abs(a * gradient.dy - b * gradient.dx);
    const float dot = std::abs(a * gradient.dx + b * gradient.dy);
    const bool flat = gradient.dx == 0 && gradient.dy == 0;
    if (flat ? flat_agrees : cross <= tangent * dot) {
      ++verdict.agreeing;
    } else {
      ++verdict.disagreeing;
    }
  }
  return verdict;
}

}  // namespace evolin::elsed
