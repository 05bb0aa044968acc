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
#include "near_lines.h"

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

/// The lines of a frame in its image.
struct LinesInImage {
  LineSegments lines;
  std::vector<std::uint32_t> rows;  ///< of each in the frame

  explicit LinesInImage(const SpatialFrame& frame) {
    lines.reserve(frame.lines.size());
    rows.reserve(frame.lines.size());
    for (std::size_t row = 0; row < frame.lines.size(); ++row) {
      if (frame.lines[row].in_image) {
        lines.push_back(frame.lines[row].segment);
        rows.push_back(static_cast<std::uint32_t>(row));
      }
    }
  }
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

void OneToOneRepeatability::addDirection(const ProjectedLines& projected) {
  const std::vector<LineProjection>& projections = projected.projections();
  const SpatialFrame& to = projected.to();
  const double tangent = largestTangent(options_.max_angle);
  const LinesInImage inside(to);
  NearLines lines(inside.lines);
  NearQuestion question;
  question.orthogonal = true;
  question.reach = options_.max_distance;
  question.min_overlap = options_.min_overlap;
  std::vector<double> lengths;  // of the projections
  lengths.reserve(projections.size());
  std::vector<Candidate> candidates;
  candidates.reserve(2 * projections.size());
  std::vector<std::uint32_t> of_projections(projections.size());  // candidates of each
  std::vector<std::uint32_t> of_lines(to.lines.size());
  for (std::size_t index = 0; index < projections.size(); ++index) {
    const LineSegment& projection = projections[index].segment;
    ++visible_;
    lengths.push_back(projection.length());
    visible_length_.add(lengths.back());
    for (const std::uint32_t place : lines.find(projection, question).orthogonal) {
      const LineSegment& line = inside.lines[place];
      if (!isWithinAngle(projection, line, tangent)) {
        continue;
      }
      // Infinite, so no candidate, when the line has no length.
      const double distance = orthogonalDistance(projection, line, false);
      if (distance <= options_.max_distance &&
          (coveredShare(projection, line) + coveredShare(line, projection)) / 2 >=
              options_.min_overlap) {
        candidates.push_back({distance, index, inside.rows[place]});
        ++of_projections[index];
        ++of_lines[inside.rows[place]];
      }
    }
  }
  const auto match = [&](const Candidate& candidate) {
    ++matched_;
    matched_length_.add(
        lengths[candidate.projection] *
        coveredShare(projections[candidate.projection].segment, to.lines[candidate.line].segment));
  };
  // Most have no rival: whatever the order, they match.
  const auto contested =
      std::partition(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
        return of_projections[candidate.projection] == 1 && of_lines[candidate.line] == 1;
      });
  std::for_each(candidates.begin(), contested, match);
  std::sort(contested, candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.projection, a.line) < std::tie(b.distance, b.projection, b.line);
  });
  std::vector<bool> projection_taken(projections.size(), false);
  std::vector<bool> line_taken(to.lines.size(), false);
  for (auto candidate = contested; candidate != candidates.end(); ++candidate) {
    if (!projection_taken[candidate->projection] && !line_taken[candidate->line]) {
      projection_taken[candidate->projection] = true;
      line_taken[candidate->line] = true;
      match(*candidate);
    }
  }
}

OneToOneRepeatability OneToOneRepeatability::addPair(const SpatialFrame& first,
                                                     const SpatialFrame& second) {
  return addPair(ProjectedPair(first, second));
}

OneToOneRepeatability OneToOneRepeatability::addPair(const ProjectedPair& projected) {
  OneToOneRepeatability pair(options_);
  pair.pairs_ = 1;
  pair.addDirection(projected.forward);
  pair.addDirection(projected.backward);
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
