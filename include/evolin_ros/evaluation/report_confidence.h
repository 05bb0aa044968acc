// Bootstrap intervals of a report's headline figures.
#pragma once

#include "evolin_ros/evaluation/report.h"
#include "evolin_ros/metrics/bootstrap.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

/// Adds `report->confidence`: precision, recall, F-score and average precision, repeatability and
/// localisation error, and the medians of relative pose, of every family that has frames or pairs.
/// `detection` is what the report was made of. A block is at most as long as a family has frames or
/// pairs. Time grows with resamples times predictions: some seconds for a thousand resamples of
/// thousands of frames. Throws as blockBootstrap().
void addConfidence(const VectorizedMetrics& detection, const BootstrapOptions& options,
                   Report* report);

}  // namespace evolin
