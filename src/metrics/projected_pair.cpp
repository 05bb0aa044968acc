// Projections, scaled and searched for when they are asked for.
#include "evolin_ros/metrics/projected_pair.h"

#include <algorithm>
#include <cmath>

#include "nearest_line.h"
#include "scaling.h"

namespace evolin {

ProjectedLines::ProjectedLines(const SpatialFrame& from, const SpatialFrame& to,
                               double score_threshold)
    : from_(from), to_(to), projections_(projectLines(from, to, score_threshold)) {}

ProjectedLines::~ProjectedLines() = default;

const LineSegments& ProjectedLines::scaledProjections() {
  if (scaled_.size() != projections_.size()) {
    scaled_.reserve(projections_.size());
    for (const LineProjection& projection : projections_) {
      scaled_.push_back(scaled(projection.segment, to_.size));
      scaled_.back().score = from_.lines[projection.row].segment.score;
    }
  }
  return scaled_;
}

NearestLineSearch& ProjectedLines::search() {
  if (!search_) {
    search_ = std::make_unique<NearestLineSearch>(scaledLines(to_));
  }
  return *search_;
}

ProjectedLines::Nearest& ProjectedLines::nearestOf(LineDistance distance) {
  return nearest_[distance == LineDistance::kStructural ? 1 : 0];
}

const std::vector<double>& ProjectedLines::nearestDistances(LineDistance distance, double reach) {
  Nearest& nearest = nearestOf(distance);
  if (nearest.reach >= reach) {
    return nearest.distances;
  }
  const LineSegments& queries = scaledProjections();
  nearest.reach = reach;
  nearest.distances.resize(queries.size(), std::numeric_limits<double>::infinity());
  for (std::size_t index = 0; index < queries.size(); ++index) {
    // What was found within a shorter reach is the nearest within any.
    if (std::isinf(nearest.distances[index])) {
      nearest.distances[index] = search().find(distance, queries[index], reach, gate()).distance;
    }
  }
  return nearest.distances;
}

void ProjectedLines::searchBoth(double reach) {
  Nearest& orthogonal = nearestOf(LineDistance::kOrthogonal);
  Nearest& structural = nearestOf(LineDistance::kStructural);
  if (std::max(orthogonal.reach, structural.reach) >= 0) {
    return;  // what is known already is not searched for again
  }
  const LineSegments& queries = scaledProjections();
  orthogonal.distances.reserve(queries.size());
  structural.distances.reserve(queries.size());
  for (const LineSegment& query : queries) {
    const NearestLines found = search().findBoth(query, reach, gate());
    orthogonal.distances.push_back(found.orthogonal.distance);
    structural.distances.push_back(found.structural.distance);
  }
  orthogonal.reach = reach;
  structural.reach = reach;
}

}  // namespace evolin
