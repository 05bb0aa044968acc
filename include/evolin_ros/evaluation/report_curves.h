// Precision-recall curves of a report, for drawing.
#pragma once

#include <string>

#include "evolin_ros/evaluation/report.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

/// Adds `report->curves`: one a setting of the detection, by falling score, each thinned to at most
/// `points` points that keep its first and last one. None without scores, or when the report has
/// no detection. `detection` is what the report was made of. Sorts all predictions once. Throws
/// Error for fewer than two points.
void addCurves(const VectorizedMetrics& detection, Report* report, std::size_t points = 400);

/// One row a point: distance, threshold, recall, precision.
std::string curvesToCsv(const Report& report);

}  // namespace evolin
