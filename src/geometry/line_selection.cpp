// Thresholds first, then the number.
#include "evolin_ros/geometry/line_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace evolin {

namespace {

/// What the number of lines is cut by; a total order, NaN last.
double rankOf(const LineSegment& line, bool by_score) {
  const double rank = by_score ? line.score : line.length();
  return std::isnan(rank) ? -std::numeric_limits<double>::infinity() : rank;
}

LineSegments best(const LineSegments& lines, std::size_t count) {
  const bool by_score = std::any_of(lines.begin(), lines.end(),
                                    [](const LineSegment& line) { return line.hasScore(); });
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return rankOf(lines[a], by_score) > rankOf(lines[b], by_score);
  });
  order.resize(count);
  std::sort(order.begin(), order.end());
  LineSegments kept;
  kept.reserve(count);
  for (const std::size_t row : order) {
    kept.push_back(lines[row]);
  }
  return kept;
}

}  // namespace

LineSegments selectLines(LineSegments lines, const LineSelection& selection) {
  if (selection.keepsAll()) {
    return lines;
  }
  const bool by_score = selection.score_threshold > LineSelection::kNoScoreThreshold;
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                             [&](const LineSegment& line) {
                               const bool weak = by_score && line.hasScore() &&
                                                 !(line.score > selection.score_threshold);
                               return weak || line.length() < selection.min_length;
                             }),
              lines.end());
  return selection.max_lines > 0 && lines.size() > selection.max_lines
             ? best(lines, selection.max_lines)
             : lines;
}

}  // namespace evolin
