// Weights are added up along the sorted errors, to the middle.
#include "evolin_ros/metrics/resampled_pose_errors.h"

#include <algorithm>
#include <limits>
#include <string>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

std::vector<std::pair<double, std::uint32_t>> sortedBy(double PoseErrors::*error,
                                                       const std::vector<PosePair>& pairs) {
  std::vector<std::pair<double, std::uint32_t>> sorted;
  sorted.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    sorted.emplace_back(
        pair.errors ? (*pair.errors).*error : std::numeric_limits<double>::infinity(),
        static_cast<std::uint32_t>(sorted.size()));
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The mean of the two in the middle, of `total` values, more than none.
double medianOf(const std::vector<std::pair<double, std::uint32_t>>& sorted,
                const std::vector<std::uint32_t>& weights, std::uint64_t total) {
  std::uint64_t passed = 0;
  auto entry = sorted.begin();
  const auto at = [&](std::uint64_t place) {
    while (passed + weights[entry->second] <= place) {
      passed += weights[entry->second];
      ++entry;
    }
    return entry->first;
  };
  const double low = at((total - 1) / 2);
  const double high = at(total / 2);
  return low == high ? low : (low + high) / 2;  // also where both are infinite
}

}  // namespace

ResampledPoseErrors::ResampledPoseErrors(const std::vector<PosePair>& pairs)
    : rotation_(sortedBy(&PoseErrors::rotation, pairs)),
      translation_angle_(sortedBy(&PoseErrors::translation_angle, pairs)),
      translation_(sortedBy(&PoseErrors::translation, pairs)) {}

PoseErrors ResampledPoseErrors::medians(const std::vector<std::uint32_t>& weights) const {
  if (weights.size() != rotation_.size()) {
    throw Error("pose error: " + std::to_string(weights.size()) + " weights, expected " +
                std::to_string(rotation_.size()) + ", one a pair");
  }
  std::uint64_t total = 0;
  for (const std::uint32_t weight : weights) {
    total += weight;
  }
  if (total == 0) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {kNan, kNan, kNan};
  }
  return {medianOf(rotation_, weights, total), medianOf(translation_angle_, weights, total),
          medianOf(translation_, weights, total)};
}

}  // namespace evolin
