// The smallest distances of projections to lines.
#include "evolin_ros/metrics/best_localization.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "evolin_ros/base/error.h"
#include "nearest_line.h"
#include "scaling.h"

namespace evolin {

namespace {

/// Searches in small neighbourhoods are quick, and mostly they find as many as are wanted. No two
/// lines of the scaled frame are farther apart than the last.
constexpr double kReaches[] = {kScaledSide / 64, kScaledSide / 8, 4 * kScaledSide};

void checkCount(const BestLocalizationOptions& options) {
  if (options.count == 0) {
    throw Error("localisation error of the 0 best: expected 1 or more");
  }
}

/// The lines of one frame, and projections of the other's that have not met any of them yet.
class Direction {
 public:
  Direction(const SpatialFrame& from, const SpatialFrame& to, LineDistance distance)
      : distance_(distance), gate_(to.protocol == Protocol::kEvolin), search_(scaledLines(to)) {
    for (const LineProjection& projection : projectLines(from, to)) {
      queries_.push_back(scaled(projection.segment, to.size));
    }
  }

  /// Distances up to `reach` of projections that no earlier call found.
  void collect(double reach, std::vector<double>* distances) {
    const auto found = [&](const LineSegment& query) {
      const NearestLine nearest = search_.find(distance_, query, reach, gate_);
      if (std::isfinite(nearest.distance)) {
        distances->push_back(nearest.distance);
        return true;
      }
      return false;
    };
    queries_.erase(std::remove_if(queries_.begin(), queries_.end(), found), queries_.end());
  }

 private:
  static LineSegments scaledLines(const SpatialFrame& frame) {
    LineSegments lines;
    for (const SpatialLine& line : frame.lines) {
      if (line.in_image) {
        lines.push_back(scaled(line.segment, frame.size));
      }
    }
    return lines;
  }

  LineDistance distance_;
  bool gate_;
  NearestLineSearch search_;
  LineSegments queries_;
};

}  // namespace

PairBestLocalization measureBestLocalization(const SpatialFrame& first, const SpatialFrame& second,
                                             const BestLocalizationOptions& options) {
  checkCount(options);
  Direction forward(first, second, options.distance);
  Direction backward(second, first, options.distance);
  std::vector<double> distances;
  for (const double reach : kReaches) {
    forward.collect(reach, &distances);
    backward.collect(reach, &distances);
    if (distances.size() >= options.count) {
      break;  // what is farther away is not among the best
    }
  }
  PairBestLocalization result;
  result.used = std::min(options.count, distances.size());
  const auto end = distances.begin() + static_cast<std::ptrdiff_t>(result.used);
  std::partial_sort(distances.begin(), end, distances.end());
  if (result.used > 0) {
    result.mean_distance =
        std::accumulate(distances.begin(), end, 0.0) / static_cast<double>(result.used);
  }
  return result;
}

BestLocalization::BestLocalization(BestLocalizationOptions options) : options_(options) {
  checkCount(options);
}

PairBestLocalization BestLocalization::addPair(const SpatialFrame& first,
                                               const SpatialFrame& second) {
  const PairBestLocalization pair = measureBestLocalization(first, second, options_);
  ++pairs_;
  short_pairs_ += pair.used < options_.count ? 1 : 0;
  empty_pairs_ += pair.used == 0 ? 1 : 0;
  sum_.add(pair.mean_distance);
  return pair;
}

std::optional<double> BestLocalization::error() const {
  const std::size_t counted = pairs_ - empty_pairs_;
  return counted == 0 ? std::nullopt
                      : std::optional<double>(sum_.value() / static_cast<double>(counted));
}

void BestLocalization::merge(const BestLocalization& other) {
  if (options_.distance != other.options_.distance || options_.count != other.options_.count) {
    throw Error("cannot merge localisation errors of the best: distances or numbers differ");
  }
  pairs_ += other.pairs_;
  short_pairs_ += other.short_pairs_;
  empty_pairs_ += other.empty_pairs_;
  sum_ += other.sum_;
}

void BestLocalization::reset() { *this = BestLocalization(options_); }

}  // namespace evolin
