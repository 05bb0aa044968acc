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

/// No two lines of the scaled frame are farther apart.
constexpr double kUnlimited = 4 * kScaledSide;

/// Most have a line this near, and a search in a small neighbourhood is quick.
constexpr double kUsual = kScaledSide / 8;

void checkCount(const BestLocalizationOptions& options) {
  if (options.count == 0) {
    throw Error("localisation error of the 0 best: expected 1 or more");
  }
}

void collectDistances(const SpatialFrame& from, const SpatialFrame& to, LineDistance distance,
                      std::vector<double>* distances) {
  LineSegments lines;
  for (const SpatialLine& line : to.lines) {
    if (line.in_image) {
      lines.push_back(scaled(line.segment, to.size));
    }
  }
  NearestLineSearch search(lines);
  for (const LineProjection& projection : projectLines(from, to)) {
    const LineSegment query = scaled(projection.segment, to.size);
    const bool gate = to.protocol == Protocol::kEvolin;
    NearestLine nearest = search.find(distance, query, kUsual, gate);
    if (!std::isfinite(nearest.distance)) {
      nearest = search.find(distance, query, kUnlimited, gate);
    }
    if (std::isfinite(nearest.distance)) {
      distances->push_back(nearest.distance);
    }
  }
}

}  // namespace

PairBestLocalization measureBestLocalization(const SpatialFrame& first, const SpatialFrame& second,
                                             const BestLocalizationOptions& options) {
  checkCount(options);
  std::vector<double> distances;
  collectDistances(first, second, options.distance, &distances);
  collectDistances(second, first, options.distance, &distances);
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
