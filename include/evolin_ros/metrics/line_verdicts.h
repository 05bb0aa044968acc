// What became of every single line of a frame under the vectorized detection metrics: for pictures
// and lists of errors.
#pragma once

#include <cstddef>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/classification.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

/// kDropped: the protocol does not score the line (see docs/METRICS.md).
enum class LineVerdict { kTruePositive, kFalsePositive, kDropped };

struct LineVerdicts {
  std::vector<LineVerdict> predicted;  ///< one a predicted line
  std::vector<bool> found;             ///< one a ground-truth line: it has a true positive

  std::size_t count(LineVerdict verdict) const;
  std::size_t misses() const;

  /// What the frame adds to precision and recall; dropped lines add nothing.
  Classification counts() const;
};

/// The verdicts behind the counts that VectorizedMetrics gives of this frame under `setting`; takes
/// and throws the same as its addFrame(), and Error for a threshold that is not positive and
/// finite.
LineVerdicts judgeLines(const VectorizedSetting& setting, Protocol protocol, ImageSize size,
                        const LineSegments& predicted, const LineSegments& ground_truth,
                        bool scored);

}  // namespace evolin
