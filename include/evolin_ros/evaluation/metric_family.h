// The families of metrics that an evaluation can be asked for.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace evolin {

enum class MetricFamily {
  kDetection,
  kHeatmap,
  kRepeatability,
  kAssociation,  ///< of ground-truth lines and of detected ones
  kPose,
  kTracks,
};

using MetricFamilies = std::set<MetricFamily>;

/// In the order of the report.
const std::vector<MetricFamily>& allMetricFamilies();

/// "detection", "heatmap", ...
std::string toString(MetricFamily family);

/// Throws Error naming the text and the accepted ones.
MetricFamily parseMetricFamily(const std::string& text);

}  // namespace evolin
