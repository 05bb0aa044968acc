// Suppression of segments by the distances of their endpoints.
#include "evolin_ros/inference/segment_suppression.h"

#include <algorithm>

namespace evolin {
namespace {

double squared(double dx, double dy) { return dx * dx + dy * dy; }

double endpointDistance(const LineSegment& a, const LineSegment& b) {
  return std::min(squared(a.x1 - b.x1, a.y1 - b.y1) + squared(a.x2 - b.x2, a.y2 - b.y2),
                  squared(a.x1 - b.x2, a.y1 - b.y2) + squared(a.x2 - b.x1, a.y2 - b.y1));
}

}  // namespace

LineSegments suppressSegments(const LineSegments& lines, double threshold) {
  LineSegments sorted;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(sorted),
               [](const LineSegment& line) { return line.isFinite(); });
  std::stable_sort(sorted.begin(), sorted.end(), [](const LineSegment& a, const LineSegment& b) {
    return a.hasScore() && (!b.hasScore() || a.score > b.score);
  });
  LineSegments kept;
  for (const LineSegment& line : sorted) {
    const bool repeats = std::any_of(kept.begin(), kept.end(), [&](const LineSegment& better) {
      return endpointDistance(line, better) <= threshold;
    });
    if (!repeats) {
      kept.push_back(line);
    }
  }
  return kept;
}

}  // namespace evolin
