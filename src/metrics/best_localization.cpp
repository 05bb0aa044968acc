// The smallest distances of projections to lines.
#include "evolin_ros/metrics/best_localization.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "evolin_ros/base/error.h"
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

void appendFinite(const std::vector<double>& values, std::vector<double>* result) {
  std::copy_if(values.begin(), values.end(), std::back_inserter(*result),
               [](double value) { return std::isfinite(value); });
}

}  // namespace

PairBestLocalization measureBestLocalization(const SpatialFrame& first, const SpatialFrame& second,
                                             const BestLocalizationOptions& options) {
  checkCount(options);
  ProjectedPair pair(first, second);
  return measureBestLocalization(options, &pair);
}

PairBestLocalization measureBestLocalization(const BestLocalizationOptions& options,
                                             ProjectedPair* pair) {
  checkCount(options);
  std::vector<double> distances;
  for (const double reach : kReaches) {
    distances.clear();
    appendFinite(pair->forward.nearestDistances(options.distance, reach), &distances);
    appendFinite(pair->backward.nearestDistances(options.distance, reach), &distances);
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
  ProjectedPair pair(first, second);
  return addPair(&pair);
}

PairBestLocalization BestLocalization::addPair(ProjectedPair* pair) {
  const PairBestLocalization result = measureBestLocalization(options_, pair);
  ++pairs_;
  short_pairs_ += result.used < options_.count ? 1 : 0;
  empty_pairs_ += result.used == 0 ? 1 : 0;
  sum_.add(result.mean_distance);
  return result;
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
