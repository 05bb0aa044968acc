// Exact distances of what the bounds leave.
#include "nearest_line.h"

#include <utility>

namespace evolin {

NearestLineSearch::NearestLineSearch(LineSegments lines)
    : lines_(std::move(lines)), near_(lines_) {}

NearestLine NearestLineSearch::find(LineDistance distance, const LineSegment& query, double reach,
                                    bool overlap_gate) {
  const bool structural = distance == LineDistance::kStructural;
  NearQuestion question;
  question.distance = distance;
  question.reach = reach;
  question.min_overlap = overlap_gate ? 0.5 : 0;
  question.nearest = true;
  NearestLine nearest;
  for (const std::uint32_t row : near_.find(query, question)) {
    const double exact = structural ? structuralDistance(query, lines_[row])
                                    : orthogonalDistance(query, lines_[row], overlap_gate);
    if (exact <= reach &&
        (exact < nearest.distance || (exact == nearest.distance && row < nearest.row))) {
      nearest = {row, exact};
    }
  }
  return nearest;
}

}  // namespace evolin
