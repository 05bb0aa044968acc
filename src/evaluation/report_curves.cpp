// Thinning and writing of precision-recall curves.
#include "evolin_ros/evaluation/report_curves.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

PrecisionRecallCurve thinned(const PrecisionRecallCurve& curve, std::size_t points) {
  const std::size_t size = curve.recall.size();
  if (size <= points) {
    return curve;
  }
  PrecisionRecallCurve kept;
  kept.recall.reserve(points);
  kept.precision.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t from = i * (size - 1) / (points - 1);
    kept.recall.push_back(curve.recall[from]);
    kept.precision.push_back(curve.precision[from]);
  }
  return kept;
}

}  // namespace

void addCurves(const VectorizedMetrics& detection, Report* report, std::size_t points) {
  if (points < 2) {
    throw Error("curves of " + std::to_string(points) + " points; expected at least 2");
  }
  report->curves.clear();
  if (!detection.scored() || report->families.count(MetricFamily::kDetection) == 0) {
    return;
  }
  const ScoreRanking ranking = detection.ranking();
  for (std::size_t i = 0; i < detection.settings().size(); ++i) {
    report->curves.push_back({detection.settings()[i], thinned(ranking.curve(i), points)});
  }
}

std::string curvesToCsv(const Report& report) {
  std::string text = "distance,threshold,recall,precision\n";
  for (const DetectionCurve& curve : report.curves) {
    const std::string setting =
        toString(curve.setting.distance) + "," + formatDouble(curve.setting.threshold) + ",";
    for (std::size_t i = 0; i < curve.points.recall.size(); ++i) {
      text += setting + formatDouble(curve.points.recall[i]) + "," +
              formatDouble(curve.points.precision[i]) + "\n";
    }
  }
  return text;
}

}  // namespace evolin
