// One frame of the vectorized detection metrics: lines prepared by the protocol's rules, and which
// predictions take which ground-truth lines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

/// Throws Error naming the frame for an image without pixels.
void checkSize(const std::string& frame, ImageSize size);

/// Scaled to 128 x 128. Throws GroundTruthError as VectorizedMetrics::addFrame().
LineSegments prepareGroundTruth(const std::string& frame, ImageSize size,
                                const LineSegments& lines);

struct PreparedPredictions {
  LineSegments lines;               ///< without those that the protocol drops
  std::vector<std::uint32_t> rows;  ///< of each among the lines given
};

/// Scaled by the protocol's rule. Throws Error as VectorizedMetrics::addFrame().
PreparedPredictions preparePredictions(const std::string& frame, ImageSize size,
                                       const LineSegments& lines, bool with_scores,
                                       Protocol protocol);

/// One word of bits a prediction, in the order of options.distances x options.distance_thresholds;
/// both kinds of lines prepared.
std::vector<std::uint32_t> findHits(const LineSegments& predictions,
                                    const LineSegments& ground_truth, bool scored,
                                    const VectorizedOptions& options);

/// For every ground-truth row the prediction that is its true positive, or -1; both kinds of lines
/// prepared.
std::vector<std::int64_t> findTakers(const LineSegments& predictions,
                                     const LineSegments& ground_truth, bool scored,
                                     const VectorizedSetting& setting, Protocol protocol);

}  // namespace evolin
