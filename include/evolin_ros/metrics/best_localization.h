// Localisation error of the N best redetections of each pair of frames (not in the article; a fixed
// number compares detectors that find very different numbers of lines).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/metrics/exact_sum.h"
#include "evolin_ros/metrics/projected_pair.h"
#include "evolin_ros/metrics/spatial_lines.h"

namespace evolin {

struct BestLocalizationOptions {
  LineDistance distance = LineDistance::kStructural;
  std::size_t count = 50;  ///< N
};

/// Projections of both frames' lines into the other frame, each with its distance to the nearest
/// line there, in pixels of the 128 x 128 frame: the N smallest finite ones of both directions
/// together.
struct PairBestLocalization {
  std::size_t used = 0;      ///< fewer than N where there are fewer
  double mean_distance = 0;  ///< pixels of the 128 x 128 frame; 0 without any
};

/// Throws Error when N is 0 or the frames were lifted under different protocols; the overlap gate
/// of the orthogonal distance follows their protocol.
PairBestLocalization measureBestLocalization(const SpatialFrame& first, const SpatialFrame& second,
                                             const BestLocalizationOptions& options);
PairBestLocalization measureBestLocalization(const BestLocalizationOptions& options,
                                             ProjectedPair* pair);

/// An accumulator over pairs of frames, the same to the last bit in any order.
class BestLocalization {
 public:
  /// Throws Error when N is 0.
  explicit BestLocalization(BestLocalizationOptions options = {});

  PairBestLocalization addPair(const SpatialFrame& first, const SpatialFrame& second);
  /// Of frames all of whose lines have been projected.
  PairBestLocalization addPair(ProjectedPair* pair);

  std::size_t pairs() const { return pairs_; }

  /// Pairs with fewer than N distances, those without any among them: their error is too good.
  std::size_t shortPairs() const { return short_pairs_; }

  /// Mean over the pairs that have a distance, in pixels of the 128 x 128 frame; none without such.
  std::optional<double> error() const;

  /// Throws Error when the options differ.
  void merge(const BestLocalization& other);
  void reset();

 private:
  BestLocalizationOptions options_;
  std::size_t pairs_ = 0;
  std::size_t short_pairs_ = 0;
  std::size_t empty_pairs_ = 0;
  ExactSum sum_;
};

}  // namespace evolin
