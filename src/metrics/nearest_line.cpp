// Exact distances of what the bounds leave.
#include "nearest_line.h"

#include <utility>

namespace evolin {

namespace {

/// The mean share that the orthogonal distance's gate asks for.
constexpr double kGate = 0.5;

}  // namespace

NearestLineSearch::NearestLineSearch(LineSegments lines)
    : lines_(std::move(lines)), near_(lines_) {}

NearestLine NearestLineSearch::find(LineDistance distance, const LineSegment& query, double reach,
                                    bool overlap_gate) {
  const bool structural = distance == LineDistance::kStructural;
  return findNearest({structural, !structural, reach, overlap_gate ? kGate : 0, true}, query)
      .of(distance);
}

NearestLines NearestLineSearch::findBoth(const LineSegment& query, double reach,
                                         bool overlap_gate) {
  return findNearest({true, true, reach, overlap_gate ? kGate : 0, true}, query);
}

NearestLines NearestLineSearch::findNearest(const NearQuestion& question,
                                            const LineSegment& query) {
  const NearLines::Answer candidates = near_.find(query, question);
  const auto nearest_of = [&](const NearLines::Rows& rows, const auto& distance_to) {
    NearestLine nearest;
    for (const std::uint32_t row : rows) {
      const double exact = distance_to(lines_[row]);
      if (exact <= question.reach &&
          (exact < nearest.distance || (exact == nearest.distance && row < nearest.row))) {
        nearest = {row, exact};
      }
    }
    return nearest;
  };
  const bool gate = question.min_overlap > 0;
  return {
      nearest_of(candidates.orthogonal,
                 [&](const LineSegment& line) { return orthogonalDistance(query, line, gate); }),
      nearest_of(candidates.structural,
                 [&](const LineSegment& line) { return structuralDistance(query, line); })};
}

}  // namespace evolin
