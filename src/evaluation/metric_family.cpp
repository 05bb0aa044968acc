// Names of the metric families.
#include "evolin_ros/evaluation/metric_family.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

const std::vector<MetricFamily>& allMetricFamilies() {
  static const std::vector<MetricFamily> kFamilies = {
      MetricFamily::kDetection,   MetricFamily::kHeatmap, MetricFamily::kRepeatability,
      MetricFamily::kAssociation, MetricFamily::kPose,    MetricFamily::kTracks};
  return kFamilies;
}

std::string toString(MetricFamily family) {
  switch (family) {
    case MetricFamily::kDetection:
      return "detection";
    case MetricFamily::kHeatmap:
      return "heatmap";
    case MetricFamily::kRepeatability:
      return "repeatability";
    case MetricFamily::kAssociation:
      return "association";
    case MetricFamily::kPose:
      return "pose";
    case MetricFamily::kTracks:
      break;
  }
  return "tracks";
}

MetricFamily parseMetricFamily(const std::string& text) {
  std::string names;
  for (const MetricFamily family : allMetricFamilies()) {
    if (toString(family) == text) {
      return family;
    }
    names += (names.empty() ? "" : ", ") + toString(family);
  }
  throw Error("metric family " + quote(text) + ", expected one of " + names);
}

}  // namespace evolin
