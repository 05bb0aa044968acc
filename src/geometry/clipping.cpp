// Clamping and parametric clipping of segments.
#include "evolin_ros/geometry/clipping.h"

#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

/// Narrows [*enter, *leave] to the parameters t at which start + t * delta lies in [low, high];
/// false when none is left.
bool narrow(double start, double delta, double low, double high, double* enter, double* leave) {
  if (delta == 0) {
    return low <= start && start <= high;
  }
  double first = (low - start) / delta;
  double second = (high - start) / delta;
  if (first > second) {
    std::swap(first, second);
  }
  *enter = std::max(*enter, first);
  *leave = std::min(*leave, second);
  return *enter <= *leave;
}

bool isInside(double x, double y, const Rectangle& rectangle) {
  return rectangle.left <= x && x <= rectangle.right && rectangle.top <= y && y <= rectangle.bottom;
}

}  // namespace

LineSegment clampToRectangle(const LineSegment& segment, const Rectangle& rectangle) {
  LineSegment result = segment;
  result.x1 = std::clamp(segment.x1, rectangle.left, rectangle.right);
  result.y1 = std::clamp(segment.y1, rectangle.top, rectangle.bottom);
  result.x2 = std::clamp(segment.x2, rectangle.left, rectangle.right);
  result.y2 = std::clamp(segment.y2, rectangle.top, rectangle.bottom);
  return result;
}

std::optional<LineSegment> clipToRectangle(const LineSegment& segment, const Rectangle& rectangle) {
  if (!segment.isFinite()) {
    return std::nullopt;
  }
  if (isInside(segment.x1, segment.y1, rectangle) && isInside(segment.x2, segment.y2, rectangle)) {
    return segment;
  }
  // Where differences of coordinates could overflow, all is computed at a sixteenth of the size.
  constexpr double kHuge = 1e300;
  const double scale = std::max({std::abs(segment.x1), std::abs(segment.y1), std::abs(segment.x2),
                                 std::abs(segment.y2)}) > kHuge
                           ? 0.0625
                           : 1;
  const double x = segment.x1 * scale;
  const double y = segment.y1 * scale;
  const double dx = segment.x2 * scale - x;
  const double dy = segment.y2 * scale - y;
  double enter = 0;
  double leave = 1;
  if (!narrow(x, dx, rectangle.left * scale, rectangle.right * scale, &enter, &leave) ||
      !narrow(y, dy, rectangle.top * scale, rectangle.bottom * scale, &enter, &leave)) {
    return std::nullopt;
  }
  LineSegment result = segment;
  if (enter > 0) {
    result.x1 = (x + enter * dx) / scale;
    result.y1 = (y + enter * dy) / scale;
  }
  if (leave < 1) {
    result.x2 = (x + leave * dx) / scale;
    result.y2 = (y + leave * dy) / scale;
  }
  // Rounding may leave a cut end a hair outside.
  return clampToRectangle(result, rectangle);
}

}  // namespace evolin
