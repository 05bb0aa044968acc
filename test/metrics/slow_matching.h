// The cheapest matching of pixels by the plainest way there is: over all pairs, augmenting along
// the cheapest path (Bellman and Ford) for as long as that pays. For small inputs.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "test/metrics/pixel_layouts.h"

namespace evolin::test {

/// The number of pairs of the cheapest matching of `predicted`, or that of a largest matching where
/// `free_cost` is infinite. The cost of the cheapest matching of k pairs is convex in k, and the
/// cheapest path leads from one to the next, so the first path that costs `free_cost` or more ends
/// it.
inline std::size_t countSlowly(const Pixels& ground_truth, const Pixels& predicted, int reach,
                               double free_cost) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Pair {
    std::size_t truth;
    std::size_t predicted;
    double cost;
  };
  std::vector<Pair> pairs;
  for (std::size_t g = 0; g < ground_truth.size(); ++g) {
    for (std::size_t p = 0; p < predicted.size(); ++p) {
      const double dx = ground_truth[g].x - predicted[p].x;
      const double dy = ground_truth[g].y - predicted[p].y;
      if (dx * dx + dy * dy <= reach * reach) {
        pairs.push_back({g, p, std::sqrt(dx * dx + dy * dy) + 1e-6});
      }
    }
  }
  std::vector<std::size_t> of_truth(ground_truth.size(), kNone);  // pair of each pixel
  std::vector<std::size_t> of_predicted(predicted.size(), kNone);
  for (std::size_t count = 0;; ++count) {
    const double far = std::numeric_limits<double>::infinity();
    std::vector<double> to_truth(ground_truth.size(), far);
    std::vector<double> to_predicted(predicted.size(), far);
    std::vector<std::size_t> came_by(predicted.size(), kNone);
    for (std::size_t g = 0; g < ground_truth.size(); ++g) {
      to_truth[g] = of_truth[g] == kNone ? 0 : far;
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t index = 0; index < pairs.size(); ++index) {
        const Pair& pair = pairs[index];
        // The margin is far below any difference of paths, and keeps rounding from going in rounds.
        if (to_truth[pair.truth] + pair.cost < to_predicted[pair.predicted] - 1e-10 &&
            of_truth[pair.truth] != index) {
          to_predicted[pair.predicted] = to_truth[pair.truth] + pair.cost;
          came_by[pair.predicted] = index;
          changed = true;
          if (of_predicted[pair.predicted] != kNone) {
            const Pair& back = pairs[of_predicted[pair.predicted]];
            to_truth[back.truth] = to_predicted[pair.predicted] - back.cost;
          }
        }
      }
    }
    std::size_t end = kNone;
    for (std::size_t p = 0; p < predicted.size(); ++p) {
      if (of_predicted[p] == kNone && to_predicted[p] < far &&
          (end == kNone || to_predicted[p] < to_predicted[end])) {
        end = p;
      }
    }
    if (end == kNone || to_predicted[end] >= free_cost) {
      return count;
    }
    for (std::size_t p = end; p != kNone;) {
      const std::size_t index = came_by[p];
      const std::size_t g = pairs[index].truth;
      const std::size_t left = of_truth[g];
      of_truth[g] = index;
      of_predicted[p] = index;
      p = left == kNone ? kNone : pairs[left].predicted;
    }
  }
}

/// For each level of the layout.
inline std::vector<std::size_t> countSlowly(const PixelLayout& layout, double free_cost) {
  std::vector<std::size_t> counts;
  Pixels predicted;
  for (const Pixels& level : layout.added) {
    predicted.insert(predicted.end(), level.begin(), level.end());
    counts.push_back(countSlowly(layout.ground_truth, predicted, layout.rule.reach, free_cost));
  }
  return counts;
}

inline std::vector<std::size_t> countSlowly(const PixelLayout& layout) {
  return countSlowly(layout, layout.rule.free_cost);
}

/// The counts of largest matchings, whatever they cost.
inline std::vector<std::size_t> countMost(const PixelLayout& layout) {
  return countSlowly(layout, std::numeric_limits<double>::infinity());
}

}  // namespace evolin::test
