// From the matching of prepared lines back to the rows that were given.
#include "evolin_ros/metrics/line_verdicts.h"

#include <algorithm>
#include <cmath>

#include "detection_matching.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

std::size_t LineVerdicts::count(LineVerdict verdict) const {
  return static_cast<std::size_t>(std::count(predicted.begin(), predicted.end(), verdict));
}

std::size_t LineVerdicts::misses() const {
  return static_cast<std::size_t>(std::count(taken_by.begin(), taken_by.end(), -1));
}

LineVerdicts judgeLines(const VectorizedSetting& setting, Protocol protocol,
                        const std::string& frame_name, ImageSize size,
                        const LineSegments& predicted, const LineSegments& ground_truth,
                        bool scored) {
  if (!(setting.threshold > 0) || !std::isfinite(setting.threshold)) {
    throw Error("distance threshold " + formatDouble(setting.threshold) +
                ": expected a positive, finite number of pixels");
  }
  checkSize(frame_name, size);
  const LineSegments truth = prepareGroundTruth(frame_name, size, ground_truth);
  const PreparedPredictions prepared =
      preparePredictions(frame_name, size, predicted, scored, protocol);
  LineVerdicts verdicts;
  verdicts.predicted.assign(predicted.size(), LineVerdict::kDropped);
  for (const std::uint32_t row : prepared.rows) {
    verdicts.predicted[row] = LineVerdict::kFalsePositive;
  }
  verdicts.taken_by = findTakers(prepared.lines, truth, scored, setting, protocol);
  for (std::int64_t& taker : verdicts.taken_by) {
    if (taker >= 0) {
      taker = prepared.rows[static_cast<std::size_t>(taker)];
      verdicts.predicted[static_cast<std::size_t>(taker)] = LineVerdict::kTruePositive;
    }
  }
  return verdicts;
}

}  // namespace evolin
