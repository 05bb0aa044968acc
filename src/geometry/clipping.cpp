// Clamping and parametric clipping of segments.
#include "evolin_ros/geometry/clipping.h"

#include <algorithm>

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
  const double dx = segment.x2 - segment.x1;
  const double dy = segment.y2 - segment.y1;
  double enter = 0;
  double leave = 1;
  if (!narrow(segment.x1, dx, rectangle.left, rectangle.right, &enter, &leave) ||
      !narrow(segment.y1, dy, rectangle.top, rectangle.bottom, &enter, &leave)) {
    return std::nullopt;
  }
  LineSegment result = segment;
  if (enter > 0) {
    result.x1 = segment.x1 + enter * dx;
    result.y1 = segment.y1 + enter * dy;
  }
  if (leave < 1) {
    result.x2 = segment.x1 + leave * dx;
    result.y2 = segment.y1 + leave * dy;
  }
  // Rounding may leave a cut end a hair outside.
  return clampToRectangle(result, rectangle);
}

}  // namespace evolin
