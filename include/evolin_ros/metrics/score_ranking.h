// Predictions of a whole sequence in the order of their scores: what precision-recall curves and
// average precision are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evolin_ros/metrics/protocol.h"

namespace evolin {

/// Points by falling score, one a prediction.
struct PrecisionRecallCurve {
  std::vector<double> recall;
  std::vector<double> precision;
};

/// An immutable snapshot; all const functions may run at the same time.
class ScoreRanking {
 public:
  /// A prediction: its frame by index, and bit k of `hits` for a true positive under setting k.
  struct Entry {
    std::uint32_t frame;
    std::uint32_t hits;
  };

  ScoreRanking() = default;

  /// `entries` by falling score; `ground_truth` lines of every frame; at most 32 settings.
  ScoreRanking(Protocol protocol, std::size_t settings, std::vector<Entry> entries,
               std::vector<std::uint32_t> ground_truth);

  /// Recall is 0 throughout when there is no ground truth.
  PrecisionRecallCurve curve(std::size_t setting) const;

  /// Area under each setting's curve by the trapezoid rule, without interpolation. Under kEvolin
  /// the curve starts at its first point, so one perfect prediction of one line gives 0; under
  /// kPaper it is anchored at (0, first precision). Empty without predictions or without ground
  /// truth.
  std::vector<std::optional<double>> averagePrecisions() const;

  Protocol protocol() const { return protocol_; }
  std::size_t settings() const { return settings_; }
  const std::vector<Entry>& entries() const { return entries_; }
  const std::vector<std::uint32_t>& groundTruth() const { return ground_truth_; }

 private:
  Protocol protocol_ = Protocol::kEvolin;
  std::size_t settings_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> ground_truth_;
};

}  // namespace evolin
