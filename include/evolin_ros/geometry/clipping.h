// Two ways of bringing a segment inside a rectangle: moving its coordinates, or cutting it.
#pragma once

#include <optional>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// A closed axis-parallel rectangle in the segment's unit.
struct Rectangle {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

/// Moves every coordinate on its own to the nearest inside value; this may turn the segment. Score
/// and id stay.
LineSegment clampToRectangle(const LineSegment& segment, const Rectangle& rectangle);

/// The part of the segment inside the rectangle, its direction, score and id kept; empty when
/// nothing of it is inside or a coordinate is not finite. A segment that lies inside is returned
/// unchanged to the last bit (Liang and Barsky 1984).
std::optional<LineSegment> clipToRectangle(const LineSegment& segment, const Rectangle& rectangle);

}  // namespace evolin
