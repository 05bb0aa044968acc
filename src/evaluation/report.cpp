// Summaries that every form of the report shares, and writing it to disk.
#include "evolin_ros/evaluation/report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/evaluation/report_curves.h"

namespace evolin {

namespace {

constexpr char kFrames[] = "frames.csv";
constexpr char kCurves[] = "curves.csv";
constexpr char kPairs[] = "pairs.csv";
constexpr char kRepeatabilities[] = "repeatability.csv";
constexpr char kPoses[] = "poses.csv";
constexpr char kTrueMotions[] = "relative_motion_ground_truth.tum";
constexpr char kEstimatedMotions[] = "relative_motion_estimate.tum";
constexpr char kSummary[] = "summary.md";
constexpr char kReport[] = "report.json";

/// Linear between neighbours; `sorted` is not empty, `fraction` in [0, 1].
double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

std::string toString(FrameState state) {
  switch (state) {
    case FrameState::kWaiting:
      return "waiting";
    case FrameState::kEvaluated:
      return "evaluated";
    case FrameState::kUnmatched:
      return "unmatched";
    case FrameState::kDropped:
      return "dropped";
    case FrameState::kNoGroundTruth:
      return "no_ground_truth";
    case FrameState::kBadGroundTruth:
      return "bad_ground_truth";
    case FrameState::kSkipped:
      break;
  }
  return "skipped";
}

std::size_t& CoverageCounts::of(FrameState state) {
  switch (state) {
    case FrameState::kWaiting:
      return waiting;
    case FrameState::kEvaluated:
      return evaluated;
    case FrameState::kUnmatched:
      return unmatched;
    case FrameState::kDropped:
      return dropped;
    case FrameState::kNoGroundTruth:
      return no_ground_truth;
    case FrameState::kBadGroundTruth:
      return bad_ground_truth;
    case FrameState::kSkipped:
      break;
  }
  return skipped;
}

void CoverageCounts::add(FrameState state) {
  ++seen;
  ++of(state);
}

void CoverageCounts::remove(FrameState state) {
  --seen;
  --of(state);
}

TimingSummary summarizeTimes(std::vector<double> times) {
  TimingSummary summary;
  summary.frames = times.size();
  if (times.empty()) {
    return summary;
  }
  std::sort(times.begin(), times.end());
  summary.mean =
      std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
  summary.median = quantile(times, 0.5);
  summary.p95 = quantile(times, 0.95);
  summary.max = times.back();
  summary.rate = 1 / summary.mean;
  return summary;
}

std::filesystem::path writeReport(const Report& report, const std::filesystem::path& folder) {
  writeFileAtomically(folder / kFrames, framesToCsv(report));
  writeFileAtomically(folder / kPairs, pairsToCsv(report));
  if (report.families.count(MetricFamily::kRepeatability) != 0) {
    writeFileAtomically(folder / kRepeatabilities, repeatabilityToCsv(report));
  }
  if (report.families.count(MetricFamily::kPose) != 0) {
    writeFileAtomically(folder / kPoses, posesToCsv(report));
    writeFileAtomically(folder / kTrueMotions, motionsToTum(report, false));
    writeFileAtomically(folder / kEstimatedMotions, motionsToTum(report, true));
  }
  if (!report.curves.empty()) {
    writeFileAtomically(folder / kCurves, curvesToCsv(report));
  } else {  // one of an earlier state is not of this report
    std::error_code ignored;
    std::filesystem::remove(folder / kCurves, ignored);
  }
  writeFileAtomically(folder / kSummary, toMarkdown(report));
  const std::filesystem::path file = folder / kReport;
  writeFileAtomically(file, toJson(report));
  return file;
}

void removeReport(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* name : {kFrames, kCurves, kPairs, kRepeatabilities, kPoses, kTrueMotions,
                           kEstimatedMotions, kSummary, kReport}) {
    std::filesystem::remove(folder / name, ignored);
  }
  std::filesystem::remove(folder, ignored);
}

}  // namespace evolin
