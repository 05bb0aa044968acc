// Bounds in flat loops, exact distances for what is left.
#include "nearest_line.h"

#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

float narrow(double value) { return static_cast<float>(value); }

double largestCoordinate(const LineSegment& line) {
  return std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
}

}  // namespace

NearestLineSearch::NearestLineSearch(const LineSegments& lines)
    : lines_(lines), bounds_(lines.size()), candidates_(lines.size()) {
  for (const LineSegment& line : lines) {
    largest_ = std::max(largest_, largestCoordinate(line));
    x1_.push_back(narrow(line.x1));
    y1_.push_back(narrow(line.y1));
    x2_.push_back(narrow(line.x2));
    y2_.push_back(narrow(line.y2));
    sum_x_.push_back(narrow(line.x1 + line.x2));
    sum_y_.push_back(narrow(line.y1 + line.y2));
    const float length = line.length();
    const float normal_x = (line.y1 - line.y2) / length;
    const float normal_y = (line.x2 - line.x1) / length;
    normal_x_.push_back(narrow(normal_x));
    normal_y_.push_back(narrow(normal_y));
    offset_.push_back(narrow(-(normal_x * line.x1 + normal_y * line.y1)));
  }
}

void NearestLineSearch::boundStructural(const LineSegment& query) {
  // |p1-q1| + |p2-q2| >= |(p1+p2) - (q1+q2)|, and so for the crossed pairing; kept squared.
  const float sum_x = narrow(query.x1 + query.x2);
  const float sum_y = narrow(query.y1 + query.y2);
  const std::size_t count = bounds_.size();
  const float* const xs = sum_x_.data();
  const float* const ys = sum_y_.data();
  float* const bounds = bounds_.data();
  for (std::size_t row = 0; row < count; ++row) {
    const float dx = xs[row] - sum_x;
    const float dy = ys[row] - sum_y;
    bounds[row] = dx * dx + dy * dy;
  }
}

void NearestLineSearch::boundOrthogonal(const LineSegment& query) {
  // The distance itself, without the gate and with less care for the last bits.
  const double length = query.length();
  const double normal_x = (query.y1 - query.y2) / length;
  const double normal_y = (query.x2 - query.x1) / length;
  const float query_nx = narrow(normal_x);
  const float query_ny = narrow(normal_y);
  const float query_offset = narrow(-(normal_x * query.x1 + normal_y * query.y1));
  const float query_x1 = narrow(query.x1);
  const float query_y1 = narrow(query.y1);
  const float query_x2 = narrow(query.x2);
  const float query_y2 = narrow(query.y2);
  const std::size_t count = bounds_.size();
  const float* const x1 = x1_.data();
  const float* const y1 = y1_.data();
  const float* const x2 = x2_.data();
  const float* const y2 = y2_.data();
  const float* const nx = normal_x_.data();
  const float* const ny = normal_y_.data();
  const float* const offset = offset_.data();
  float* const bounds = bounds_.data();
  for (std::size_t row = 0; row < count; ++row) {
    const float a = std::abs(query_nx * x1[row] + query_ny * y1[row] + query_offset);
    const float b = std::abs(query_nx * x2[row] + query_ny * y2[row] + query_offset);
    const float c = std::abs(nx[row] * query_x1 + ny[row] * query_y1 + offset[row]);
    const float d = std::abs(nx[row] * query_x2 + ny[row] * query_y2 + offset[row]);
    bounds[row] = 0.5F * ((a + b) + (c + d));
  }
}

NearestLine NearestLineSearch::find(LineDistance distance, const LineSegment& query, double reach,
                                    bool overlap_gate) {
  const bool structural = distance == LineDistance::kStructural;
  if (structural) {
    boundStructural(query);
  } else {
    boundOrthogonal(query);
  }
  // Single precision keeps 24 bits: the bounds are good to about 1e-6 of the largest coordinate.
  const double error = 1e-5 * (1 + std::max(largest_, largestCoordinate(query)));
  const auto toBound = [structural, error](double limit) {
    const double forgiving = (limit + error) * (1 + 1e-5);
    return narrow(structural ? forgiving * forgiving : forgiving);
  };

  // Without a branch that depends on the data; a bound that is not a number (a line without a
  // direction) is out of reach.
  const float farthest = toBound(reach);
  const std::size_t rows = bounds_.size();
  const float* const bounds = bounds_.data();
  std::uint32_t* const within_reach = candidates_.data();
  std::size_t candidates = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    within_reach[candidates] = static_cast<std::uint32_t>(row);
    candidates += bounds[row] <= farthest ? 1 : 0;
  }
  NearestLine nearest;
  float limit = farthest;
  for (std::size_t candidate = 0; candidate < candidates; ++candidate) {
    const std::uint32_t row = within_reach[candidate];
    if (bounds[row] > limit) {
      continue;
    }
    const double exact = structural ? structuralDistance(query, lines_[row])
                                    : orthogonalDistance(query, lines_[row], overlap_gate);
    if (exact <= reach && exact < nearest.distance) {
      nearest = {row, exact};
      limit = toBound(exact);
    }
  }
  return nearest;
}

}  // namespace evolin
