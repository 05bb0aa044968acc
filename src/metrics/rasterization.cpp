// Sampling lines to the last bit as the published implementation does. Compiled without contraction
// to fused multiply-add, which would turn some halves the other way.
#include "evolin_ros/metrics/rasterization.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// Numbers of this size have no binary digits behind the point, so adding it rounds (half to even,
/// the processor's way) and taking it away leaves a whole number. Far quicker than a library call.
constexpr double kRounding = 6755399441055744.0;  // 1.5 * 2^52

/// Of a number between 0 and 2^31.
int roundHalfToEven(double value) { return static_cast<int>((value + kRounding) - kRounding); }

int cutAndClamp(double coordinate, int side) {
  return static_cast<int>(std::clamp(std::trunc(coordinate), 0.0, static_cast<double>(side - 1)));
}

}  // namespace

void rasterize(const LineSegment& line, ImageSize size, Pixels* pixels) {
  if (size.width <= 0 || size.height <= 0) {
    throw Error("an image of " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                " pixels: expected a positive size");
  }
  if (!line.isFinite()) {
    throw Error("line " + formatDouble(line.x1) + "," + formatDouble(line.y1) + "," +
                formatDouble(line.x2) + "," + formatDouble(line.y2) +
                ": expected finite coordinates");
  }
  const Pixel first{cutAndClamp(line.x1, size.width), cutAndClamp(line.y1, size.height)};
  const Pixel last{cutAndClamp(line.x2, size.width), cutAndClamp(line.y2, size.height)};
  const int dx = last.x - first.x;
  const int dy = last.y - first.y;
  const int steps = std::max(std::abs(dx), std::abs(dy));
  if (dx == 0 || dy == 0) {
    // (i/steps)*delta + start, as the rule has it here, is within a rounding error of a whole
    // number.
    const int step_x = (dx > 0) - (dx < 0);
    const int step_y = (dy > 0) - (dy < 0);
    for (int i = 0; i <= steps; ++i) {
      pixels->push_back({first.x + i * step_x, first.y + i * step_y});
    }
    return;
  }
  const double step_x = static_cast<double>(dx) / steps;
  const double step_y = static_cast<double>(dy) / steps;
  const std::size_t begin = pixels->size();
  pixels->resize(begin + static_cast<std::size_t>(steps) + 1);
  Pixel* pixel = pixels->data() + begin;
  for (int i = 0; i < steps; ++i, ++pixel) {
    pixel->x = roundHalfToEven(i * step_x + first.x);
    pixel->y = roundHalfToEven(i * step_y + first.y);
  }
  *pixel = last;
}

}  // namespace evolin
