// Leaves out segments that repeat a better one.
#pragma once

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// By falling score (equal ones, and those without a score last, in their order), a segment stays
/// unless one that stayed is within `threshold` of it: in the sum of the squared distances of the
/// endpoints under the better pairing, square pixels. Segments that are not finite go.
LineSegments suppressSegments(const LineSegments& lines, double threshold);

}  // namespace evolin
