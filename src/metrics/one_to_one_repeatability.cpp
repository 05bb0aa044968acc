// Gates, and a greedy matching by distance.
#include "evolin_ros/metrics/one_to_one_repeatability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/geometry/distance.h"
#include "small_bounds.h"

namespace evolin {

namespace {

constexpr double kRightAngle = 90;

struct Candidate {
  double distance;
  std::size_t projection;
  std::size_t line;
};

/// Tangent of the largest angle; infinite at a right angle.
double largestTangent(double max_angle) {
  constexpr double kRadiansPerDegree = 0.017453292519943295;
  return max_angle < kRightAngle ? std::tan(max_angle * kRadiansPerDegree)
                                 : std::numeric_limits<double>::infinity();
}

bool isWithinAngle(const LineSegment& a, const LineSegment& b, double tangent) {
  const double ax = a.x2 - a.x1;
  const double ay = a.y2 - a.y1;
  const double bx = b.x2 - b.x1;
  const double by = b.y2 - b.y1;
  // Written so that an infinite tangent times 0 lets pass.
  return !(std::abs(ax * by - ay * bx) > tangent * std::abs(ax * bx + ay * by));
}

double largestCoordinate(const LineSegment& line) {
  return std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
}

/// Rules out most of a frame's lines in a flat loop over single precision.
class NearLines {
 public:
  explicit NearLines(const SpatialFrame& frame) {
    for (std::size_t row = 0; row < frame.lines.size(); ++row) {
      if (!frame.lines[row].in_image) {
        continue;
      }
      const LineSegment& line = frame.lines[row].segment;
      const double dx = line.x2 - line.x1;
      const double dy = line.y2 - line.y1;
      const double length = std::sqrt(dx * dx + dy * dy);
      const double normal_x = -dy / length;
      const double normal_y = dx / length;
      rows_.push_back(static_cast<std::uint32_t>(row));
      normal_x_.push_back(static_cast<float>(normal_x));
      normal_y_.push_back(static_cast<float>(normal_y));
      offset_.push_back(static_cast<float>(-(normal_x * line.x1 + normal_y * line.y1)));
      largest_ = std::max(largest_, largestCoordinate(line));
    }
    bounds_.resize(rows_.size());
    near_.reserve(rows_.size());
  }

  /// By rising row, all lines that are within `distance` of the query, and some others. Valid until
  /// the next call.
  const std::vector<std::uint32_t>& around(const LineSegment& query, double distance) {
    // The distance is at least half of what the query's endpoints are off the line.
    const std::size_t count = rows_.size();
    const auto x1 = static_cast<float>(query.x1);
    const auto y1 = static_cast<float>(query.y1);
    const auto x2 = static_cast<float>(query.x2);
    const auto y2 = static_cast<float>(query.y2);
    const float* const xs = normal_x_.data();
    const float* const ys = normal_y_.data();
    const float* const offsets = offset_.data();
    float* const bounds = bounds_.data();
    for (std::size_t i = 0; i < count; ++i) {
      bounds[i] = std::abs(xs[i] * x1 + ys[i] * y1 + offsets[i]) +
                  std::abs(xs[i] * x2 + ys[i] * y2 + offsets[i]);
    }
    // Single precision keeps 24 bits.
    const double error = 1e-5 * (1 + std::max(largest_, largestCoordinate(query)));
    const auto limit = static_cast<float>((2 * distance + 2 * error) * (1 + 1e-5));
    near_.resize(count);
    near_.resize(collectWithin(bounds, 0, count, limit, near_.data()));
    for (std::uint32_t& place : near_) {
      place = rows_[place];
    }
    return near_;
  }

 private:
  std::vector<std::uint32_t> rows_;
  std::vector<float> normal_x_, normal_y_, offset_;
  std::vector<float> bounds_;
  std::vector<std::uint32_t> near_;
  double largest_ = 0;
};

}  // namespace

OneToOneRepeatability::OneToOneRepeatability(OneToOneOptions options) : options_(options) {
  // Written so that NaN is refused.
  if (!(options.max_distance > 0) || !std::isfinite(options.max_distance)) {
    throw Error("max_distance " + formatDouble(options.max_distance) +
                ": expected a positive, finite number of pixels");
  }
  if (!(options.max_angle > 0 && options.max_angle <= kRightAngle)) {
    throw Error("max_angle " + formatDouble(options.max_angle) +
                ": expected degrees above 0, at most 90");
  }
  if (!(options.min_overlap >= 0 && options.min_overlap <= 1)) {
    throw Error("min_overlap " + formatDouble(options.min_overlap) + ": expected 0 to 1");
  }
}

void OneToOneRepeatability::addDirection(const SpatialFrame& from, const SpatialFrame& to) {
  const std::vector<LineProjection> projections = projectLines(from, to);
  const double tangent = largestTangent(options_.max_angle);
  NearLines lines(to);
  std::vector<double> lengths;  // of the projections
  lengths.reserve(projections.size());
  std::vector<Candidate> candidates;
  for (std::size_t index = 0; index < projections.size(); ++index) {
    const LineSegment& projection = projections[index].segment;
    ++visible_;
    lengths.push_back(projection.length());
    visible_length_.add(lengths.back());
    for (const std::uint32_t row : lines.around(projection, options_.max_distance)) {
      const LineSegment& line = to.lines[row].segment;
      if (!isWithinAngle(projection, line, tangent)) {
        continue;
      }
      // Infinite, so no candidate, when the line has no length.
      const double distance = orthogonalDistance(projection, line, false);
      if (distance <= options_.max_distance &&
          (coveredShare(projection, line) + coveredShare(line, projection)) / 2 >=
              options_.min_overlap) {
        candidates.push_back({distance, index, row});
      }
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.projection, a.line) < std::tie(b.distance, b.projection, b.line);
  });
  std::vector<bool> projection_taken(projections.size(), false);
  std::vector<bool> line_taken(to.lines.size(), false);
  for (const Candidate& candidate : candidates) {
    if (projection_taken[candidate.projection] || line_taken[candidate.line]) {
      continue;
    }
    projection_taken[candidate.projection] = true;
    line_taken[candidate.line] = true;
    const LineSegment& projection = projections[candidate.projection].segment;
    ++matched_;
    matched_length_.add(lengths[candidate.projection] *
                        coveredShare(projection, to.lines[candidate.line].segment));
  }
}

OneToOneRepeatability OneToOneRepeatability::addPair(const SpatialFrame& first,
                                                     const SpatialFrame& second) {
  OneToOneRepeatability pair(options_);
  pair.pairs_ = 1;
  pair.addDirection(first, second);
  pair.addDirection(second, first);
  merge(pair);
  return pair;
}

double OneToOneRepeatability::byCount() const {
  return visible_ == 0 ? 0.0 : static_cast<double>(matched_) / static_cast<double>(visible_);
}

double OneToOneRepeatability::byLength() const {
  const double length = visible_length_.value();
  return length > 0 ? matched_length_.value() / length : 0.0;
}

void OneToOneRepeatability::merge(const OneToOneRepeatability& other) {
  if (options_.max_distance != other.options_.max_distance ||
      options_.max_angle != other.options_.max_angle ||
      options_.min_overlap != other.options_.min_overlap) {
    throw Error("cannot merge one-to-one repeatabilities: the gates differ");
  }
  pairs_ += other.pairs_;
  visible_ += other.visible_;
  matched_ += other.matched_;
  visible_length_ += other.visible_length_;
  matched_length_ += other.matched_length_;
}

void OneToOneRepeatability::reset() { *this = OneToOneRepeatability(options_); }

}  // namespace evolin
