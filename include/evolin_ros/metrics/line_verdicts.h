// What became of every single line of a frame under one setting of the vectorized metrics: for
// pictures, where the metrics themselves only count.
#pragma once

#include <string>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

enum class LineVerdict {
  kTruePositive,
  kFalsePositive,
  kDropped,  ///< by the protocol's rule, so it is neither (kEvolin: exactly horizontal or vertical)
};

struct LineVerdicts {
  std::vector<LineVerdict> predicted;  ///< one a predicted line
  std::vector<bool> found;             ///< one a ground-truth line: it has a true positive
};

/// By the rules of VectorizedMetrics, whose counts these verdicts add up to. Lines in pixels of an
/// image of `size`; `scored` says whether all predictions carry scores. Throws Error for a line
/// that is not finite, for a ground-truth line without length, and for an image without size.
LineVerdicts judgeLines(const VectorizedSetting& setting, Protocol protocol, ImageSize size,
                        const LineSegments& predicted, const LineSegments& ground_truth,
                        bool scored);

}  // namespace evolin
