// Bounds in flat loops, exact distances for what is left.
#include "nearest_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "small_bounds.h"

namespace evolin {

namespace {

/// Up to here one loop over all lines is as quick as looking for those that are near.
constexpr std::size_t kSmallSet = 256;

float narrow(double value) { return static_cast<float>(value); }

double largestCoordinate(const LineSegment& line) {
  return std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
}

double squaredLength(const LineSegment& line) {
  const double dx = line.x2 - line.x1;
  const double dy = line.y2 - line.y1;
  return dx * dx + dy * dy;
}

}  // namespace

NearestLineSearch::OrthogonalQuery::OrthogonalQuery(const LineSegment& line)
    : x1(narrow(line.x1)), y1(narrow(line.y1)), x2(narrow(line.x2)), y2(narrow(line.y2)) {
  const double inverse_length = 1 / std::sqrt(squaredLength(line));
  const double unit_x = (line.y1 - line.y2) * inverse_length;
  const double unit_y = (line.x2 - line.x1) * inverse_length;
  normal_x = narrow(unit_x);
  normal_y = narrow(unit_y);
  offset = narrow(-(unit_x * line.x1 + unit_y * line.y1));
}

NearestLineSearch::NearestLineSearch(const LineSegments& lines)
    : rows_(lines.size()), bounds_(lines.size()), candidates_(lines.size()) {
  const std::size_t count = lines.size();
  fillBuckets(lines);
  lines_.reserve(count);
  for (std::vector<float>* values : {&x1_, &y1_, &x2_, &y2_, &sum_x_, &sum_y_, &squared_length_,
                                     &normal_x_, &normal_y_, &offset_}) {
    values->reserve(count);
  }
  for (const std::uint32_t row : rows_) {
    const LineSegment& line = lines[row];
    const double squared_length = squaredLength(line);
    lines_.push_back(line);
    largest_ = std::max(largest_, largestCoordinate(line));
    longest_ = std::max(longest_, std::sqrt(squared_length));
    x1_.push_back(narrow(line.x1));
    y1_.push_back(narrow(line.y1));
    x2_.push_back(narrow(line.x2));
    y2_.push_back(narrow(line.y2));
    sum_x_.push_back(narrow(line.x1 + line.x2));
    sum_y_.push_back(narrow(line.y1 + line.y2));
    squared_length_.push_back(narrow(squared_length));
    const OrthogonalQuery narrowed(line);
    normal_x_.push_back(narrowed.normal_x);
    normal_y_.push_back(narrowed.normal_y);
    offset_.push_back(narrowed.offset);
  }
}

std::size_t NearestLineSearch::bucketOf(double sum_x) const {
  // Rises with sum_x whatever the rounding, and NaN (of an infinite scale times 0) goes to 0.
  const double bucket = (sum_x - bucket_origin_) * bucket_scale_;
  return bucket > 0 ? static_cast<std::size_t>(std::min(bucket, kBuckets - 1.0)) : 0;
}

void NearestLineSearch::fillBuckets(const LineSegments& lines) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const LineSegment& line : lines) {
    low = std::min(low, line.x1 + line.x2);
    high = std::max(high, line.x1 + line.x2);
  }
  bucket_origin_ = low;
  bucket_scale_ = kBuckets / (high - low);
  for (const LineSegment& line : lines) {
    ++bucket_begin_[bucketOf(line.x1 + line.x2) + 1];
  }
  std::partial_sum(bucket_begin_.begin(), bucket_begin_.end(), bucket_begin_.begin());
  std::array<std::uint32_t, kBuckets + 1> next = bucket_begin_;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    rows_[next[bucketOf(lines[row].x1 + lines[row].x2)]++] = static_cast<std::uint32_t>(row);
  }
}

NearestLineSearch::Window NearestLineSearch::windowAround(double sum_x, double width) const {
  return {bucket_begin_[bucketOf(sum_x - width)], bucket_begin_[bucketOf(sum_x + width) + 1]};
}

std::size_t NearestLineSearch::collect(Window window, float limit) {
  // The bound of a line without a direction is not a number: it is out of reach.
  return collectWithin(bounds_.data(), window.begin, window.end, limit, candidates_.data());
}

std::size_t NearestLineSearch::boundStructural(const LineSegment& query, Window window,
                                               float limit) {
  // |p1-q1| + |p2-q2| >= |(p1+p2) - (q1+q2)|, and so for the crossed pairing; kept squared.
  const float sum_x = narrow(query.x1 + query.x2);
  const float sum_y = narrow(query.y1 + query.y2);
  const float* const xs = sum_x_.data();
  const float* const ys = sum_y_.data();
  float* const bounds = bounds_.data();
  for (std::size_t position = window.begin; position < window.end; ++position) {
    const float dx = xs[position] - sum_x;
    const float dy = ys[position] - sum_y;
    bounds[position] = dx * dx + dy * dy;
  }
  return collect(window, limit);
}

inline float NearestLineSearch::estimate(const OrthogonalQuery& query, std::size_t position) const {
  const float a =
      std::abs(query.normal_x * x1_[position] + query.normal_y * y1_[position] + query.offset);
  const float b =
      std::abs(query.normal_x * x2_[position] + query.normal_y * y2_[position] + query.offset);
  const float c =
      std::abs(normal_x_[position] * query.x1 + normal_y_[position] * query.y1 + offset_[position]);
  const float d =
      std::abs(normal_x_[position] * query.x2 + normal_y_[position] * query.y2 + offset_[position]);
  return 0.5F * ((a + b) + (c + d));
}

std::size_t NearestLineSearch::boundOrthogonal(const LineSegment& query, float limit) {
  const OrthogonalQuery narrowed(query);
  const std::size_t count = bounds_.size();
  float* const bounds = bounds_.data();
  for (std::size_t position = 0; position < count; ++position) {
    bounds[position] = estimate(narrowed, position);
  }
  return collect({0, count}, limit);
}

std::size_t NearestLineSearch::boundGated(const LineSegment& query, double reach, float limit) {
  // Where the gate lets pass, one of the two lines has the midpoint of the other within half its
  // partner's length along it and within reach across: |mid - mid|^2 <= (longer / 2)^2 + reach^2.
  // Here for sums of endpoints, so four times that.
  const double squared_length = squaredLength(query);
  const double slack = 1e-4 * (1 + largest_ * largest_);
  const double squared_reach = 4 * reach * reach * (1 + 1e-4) + slack;
  const double longer = std::max(longest_ * longest_, squared_length);
  const Window window =
      windowAround(query.x1 + query.x2, std::sqrt(longer * (1 + 1e-4) + squared_reach));
  const float sum_x = narrow(query.x1 + query.x2);
  const float sum_y = narrow(query.y1 + query.y2);
  const float query_length = narrow(squared_length);
  const float* const xs = sum_x_.data();
  const float* const ys = sum_y_.data();
  const float* const lengths = squared_length_.data();
  float* const bounds = bounds_.data();
  for (std::size_t position = window.begin; position < window.end; ++position) {
    const float dx = xs[position] - sum_x;
    const float dy = ys[position] - sum_y;
    bounds[position] = (dx * dx + dy * dy) - std::max(lengths[position], query_length);
  }
  const std::size_t near = collect(window, narrow(squared_reach));

  const OrthogonalQuery narrowed(query);
  std::uint32_t* const positions = candidates_.data();
  std::size_t candidates = 0;
  for (std::size_t index = 0; index < near; ++index) {
    const std::uint32_t position = positions[index];
    bounds[position] = estimate(narrowed, position);
    positions[candidates] = position;
    candidates += bounds[position] <= limit ? 1 : 0;
  }
  return candidates;
}

NearestLine NearestLineSearch::find(LineDistance distance, const LineSegment& query, double reach,
                                    bool overlap_gate) {
  const bool structural = distance == LineDistance::kStructural;
  // Single precision keeps 24 bits: the bounds are good to about 1e-6 of the largest coordinate.
  const double error = 1e-5 * (1 + std::max(largest_, largestCoordinate(query)));
  const auto to_bound = [structural, error](double limit) {
    const double forgiving = (limit + error) * (1 + 1e-5);
    return narrow(structural ? forgiving * forgiving : forgiving);
  };
  const float farthest = to_bound(reach);
  std::size_t candidates = 0;
  if (structural) {
    const Window window = windowAround(query.x1 + query.x2, (reach + error) * (1 + 1e-5));
    candidates = boundStructural(query, window, farthest);
  } else if (overlap_gate && lines_.size() > kSmallSet) {
    candidates = boundGated(query, reach, farthest);
  } else {
    candidates = boundOrthogonal(query, farthest);
  }
  NearestLine nearest;
  float limit = farthest;
  const auto examine = [&](std::uint32_t position) {
    const double exact = structural ? structuralDistance(query, lines_[position])
                                    : orthogonalDistance(query, lines_[position], overlap_gate);
    const std::uint32_t row = rows_[position];
    if (exact <= reach &&
        (exact < nearest.distance || (exact == nearest.distance && row < nearest.row))) {
      nearest = {row, exact};
      limit = to_bound(exact);
    }
  };
  // The most promising one first, so that its distance rules most others out.
  const auto first = candidates_.begin();
  const auto last = first + static_cast<std::ptrdiff_t>(candidates);
  const auto promising = std::min_element(
      first, last, [this](std::uint32_t a, std::uint32_t b) { return bounds_[a] < bounds_[b]; });
  if (promising != last) {
    examine(*promising);
  }
  for (auto position = first; position != last; ++position) {
    if (bounds_[*position] <= limit && position != promising) {
      examine(*position);
    }
  }
  return nearest;
}

}  // namespace evolin
