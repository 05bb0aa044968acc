// Nearest in time, but only once nothing nearer can come.
#include "evolin_ros/evaluation/stamped_depth.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace evolin {

namespace {

/// Images before those that are settled: as many frames as a front-end of several threads may give
/// out late, and a second of those whose frames still lack something.
constexpr std::ptrdiff_t kLeastSpare = 8;
constexpr std::ptrdiff_t kMostSpare = 30;

}  // namespace

StampedDepth::StampedDepth(Stamp tolerance, std::size_t capacity)
    : tolerance_(tolerance), capacity_(std::max<std::size_t>(capacity, 1)) {}

void StampedDepth::add(Stamp stamp, DepthMap depth) {
  newest_ = std::max(stamp, newest_.value_or(stamp));
  images_.insert_or_assign(stamp, std::move(depth));
  if (images_.size() > capacity_) {
    forgetOldest();
  }
}

void StampedDepth::forgetOldest() {
  forgotten_ = std::max(images_.begin()->first, forgotten_.value_or(images_.begin()->first));
  images_.erase(images_.begin());
}

void StampedDepth::trim(Stamp settled, const std::function<bool(Stamp)>& is_wanted) {
  const auto first_kept = images_.lower_bound(settled - tolerance_);
  auto before = std::distance(images_.begin(), first_kept);
  while (before > kMostSpare || (before > kLeastSpare && !is_wanted(images_.begin()->first))) {
    forgetOldest();
    --before;
  }
}

Lookup StampedDepth::find(Stamp stamp, bool complete, const DepthMap** depth) {
  const auto after = images_.lower_bound(stamp);
  auto nearest = after;
  if (after != images_.begin()) {
    const auto before = std::prev(after);
    if (after == images_.end() || stamp - before->first <= after->first - stamp) {
      nearest = before;
    }
  }
  const bool exact = after != images_.end() && after->first == stamp;
  if (!exact && !complete && (!newest_ || *newest_ < stamp)) {
    return Lookup::kNotYet;
  }
  if (exact) {
    nearest = after;
  }
  if (nearest == images_.end()) {
    return Lookup::kNever;
  }
  const Stamp distance = std::max(nearest->first - stamp, stamp - nearest->first);
  if (distance > tolerance_) {
    nearest_miss_ = std::min(distance, nearest_miss_.value_or(distance));
    return Lookup::kNever;
  }
  *depth = &nearest->second;
  return Lookup::kFound;
}

}  // namespace evolin
