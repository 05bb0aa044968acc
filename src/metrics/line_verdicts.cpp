// From the matching of prepared lines back to the rows that were given.
#include "evolin_ros/metrics/line_verdicts.h"

#include <algorithm>
#include <cmath>

#include "detection_matching.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// The caller knows which one it is.
constexpr char kFrame[] = "(the one judged)";

}  // namespace

std::size_t LineVerdicts::count(LineVerdict verdict) const {
  return static_cast<std::size_t>(std::count(predicted.begin(), predicted.end(), verdict));
}

std::size_t LineVerdicts::misses() const {
  return static_cast<std::size_t>(std::count(found.begin(), found.end(), false));
}

Classification LineVerdicts::counts() const {
  Classification counts;
  counts.true_positives = count(LineVerdict::kTruePositive);
  counts.predicted = counts.true_positives + count(LineVerdict::kFalsePositive);
  counts.ground_truth = found.size();
  return counts;
}

LineVerdicts judgeLines(const VectorizedSetting& setting, Protocol protocol, ImageSize size,
                        const LineSegments& predicted, const LineSegments& ground_truth,
                        bool scored) {
  if (!(setting.threshold > 0) || !std::isfinite(setting.threshold)) {
    throw Error("distance threshold " + formatDouble(setting.threshold) +
                ": expected a positive, finite number of pixels");
  }
  checkSize(kFrame, size);
  const LineSegments truth = prepareGroundTruth(kFrame, size, ground_truth);
  const PreparedPredictions prepared =
      preparePredictions(kFrame, size, predicted, scored, protocol);
  LineVerdicts verdicts;
  verdicts.predicted.assign(predicted.size(), LineVerdict::kDropped);
  for (const std::uint32_t row : prepared.rows) {
    verdicts.predicted[row] = LineVerdict::kFalsePositive;
  }
  for (const std::int64_t taker : findTakers(prepared.lines, truth, scored, setting, protocol)) {
    verdicts.found.push_back(taker >= 0);
    if (taker >= 0) {
      verdicts.predicted[prepared.rows[static_cast<std::size_t>(taker)]] =
          LineVerdict::kTruePositive;
    }
  }
  return verdicts;
}

}  // namespace evolin
