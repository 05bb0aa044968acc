// Distances between line segments (Ivanov, Ferrer, Kornilova 2023, section on vectorized metrics).
#pragma once

#include <string>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

enum class LineDistance { kOrthogonal, kStructural };

/// "orthogonal" or "structural".
std::string toString(LineDistance distance);

/// Sum of the two endpoint distances under the better of the two pairings; in the segments' unit.
double structuralDistance(const LineSegment& a, const LineSegment& b);

/// Mean over both directions of the summed distances of one segment's endpoints to the other's
/// infinite line; in the segments' unit. With `overlap_gate` (the published implementation)
/// infinite when the mean of the two overlaps is below 0.5. Infinite when either segment has no
/// length.
double orthogonalDistance(const LineSegment& a, const LineSegment& b, bool overlap_gate);

/// The part of `a`, as a fraction of its length, that `b` covers when projected onto it; in [0, 1];
/// 0 when `a` has no length.
double coveredShare(const LineSegment& a, const LineSegment& b);

}  // namespace evolin
