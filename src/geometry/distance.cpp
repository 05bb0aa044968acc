// Structural and orthogonal distance, written for exactness: searches over many segments bound them
// first (see metrics/nearest_line) and ask here only for the few that matter.
#include "evolin_ros/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evolin {

namespace {

double pointDistance(double x1, double y1, double x2, double y2) {
  const double dx = x1 - x2;
  const double dy = y1 - y2;
  return std::sqrt(dx * dx + dy * dy);
}

/// Sum of the distances of b's endpoints to the infinite line through a; `length` is a's.
double endpointsToLine(const LineSegment& a, double length, const LineSegment& b) {
  const double dx = a.x2 - a.x1;
  const double dy = a.y2 - a.y1;
  const double first = std::abs(dx * (b.y1 - a.y1) - dy * (b.x1 - a.x1));
  const double second = std::abs(dx * (b.y2 - a.y1) - dy * (b.x2 - a.x1));
  return (first + second) / length;
}

/// The part of a, as a fraction of its length, that b covers when projected onto it.
double overlap(const LineSegment& a, const LineSegment& b) {
  const double dx = a.x2 - a.x1;
  const double dy = a.y2 - a.y1;
  const double squared_length = dx * dx + dy * dy;
  const double t1 = (dx * (b.x1 - a.x1) + dy * (b.y1 - a.y1)) / squared_length;
  const double t2 = (dx * (b.x2 - a.x1) + dy * (b.y2 - a.y1)) / squared_length;
  const double low = std::min(t1, t2);
  const double high = std::max(t1, t2);
  return high > 0 && low < 1 ? std::min(high, 1.0) - std::max(low, 0.0) : 0.0;
}

}  // namespace

std::string toString(LineDistance distance) {
  return distance == LineDistance::kOrthogonal ? "orthogonal" : "structural";
}

double structuralDistance(const LineSegment& a, const LineSegment& b) {
  const double straight =
      pointDistance(a.x1, a.y1, b.x1, b.y1) + pointDistance(a.x2, a.y2, b.x2, b.y2);
  const double crossed =
      pointDistance(a.x1, a.y1, b.x2, b.y2) + pointDistance(a.x2, a.y2, b.x1, b.y1);
  return std::min(straight, crossed);
}

double orthogonalDistance(const LineSegment& a, const LineSegment& b, bool overlap_gate) {
  const double length_a = pointDistance(a.x1, a.y1, a.x2, a.y2);
  const double length_b = pointDistance(b.x1, b.y1, b.x2, b.y2);
  // A length that underflows to zero gives no direction either.
  if (!(length_a > 0) || !(length_b > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  if (overlap_gate && (overlap(a, b) + overlap(b, a)) / 2 < 0.5) {
    return std::numeric_limits<double>::infinity();
  }
  return (endpointsToLine(a, length_a, b) + endpointsToLine(b, length_b, a)) / 2;
}

double coveredShare(const LineSegment& a, const LineSegment& b) { return overlap(a, b); }

}  // namespace evolin
