// `evolin evaluate heatmap`.
#include <utility>

#include "classification_entries.h"
#include "detection_inputs.h"
#include "evaluate_families.h"
#include "evaluate_options.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/heatmap.h"
#include "options.h"
#include "parallel.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Scores detected lines against true lines as drawn pixels: precision, recall and F-score; with "
    "scores, the average precision, the largest F-score and the precision-recall curve over score "
    "thresholds.\n\n"
    "Usage: evolin evaluate heatmap --pred-lines DIR --gt-lines DIR --imgs DIR [OPTIONS]";

struct Request {
  DetectionFolders folders;
  EvaluateOptions common;
};

/// False when only help was wanted.
bool readRequest(const std::vector<std::string>& arguments, Request* request) {
  po::options_description description("Options");
  addDetectionOptions(
      "text file of numbers, needed with --scores; each gives the curve's point of the lines with "
      "a higher score",
      &request->folders, &description);
  addEvaluateOptions("heatmap_metrics.json", &request->common, &description);
  if (!parseOptions(kUsage, description, arguments)) {
    return false;
  }
  checkEvaluateOptions(request->common);
  if (request->folders.scored() == request->folders.score_thresholds.empty()) {
    throw UsageError(
        "--scores and --score-thresholds need each other: the curve's points are the thresholds");
  }
  return true;
}

/// Reads and scores all frames, spread over threads.
HeatmapMetrics measure(const Request& request, const HeatmapMetrics& empty) {
  const std::vector<DetectionFiles> frames = listDetectionFiles(request.folders);
  const int workers = threadsFor(request.common, frames.size());
  std::vector<HeatmapMetrics> parts(static_cast<std::size_t>(workers), empty);
  forEachTask(frames.size(), workers, [&](std::size_t task, std::size_t worker) {
    const DetectionFiles& frame = frames[task];
    try {
      parts[worker].addFrame(static_cast<std::uint32_t>(task), frame.stem, frame.readSize(),
                             frame.readPredicted(), frame.readGroundTruth());
    } catch (const GroundTruthError& error) {
      throw frame.locate(error);
    }
  });
  HeatmapMetrics metrics = empty;
  for (const HeatmapMetrics& part : parts) {
    metrics.merge(part);
  }
  return metrics;
}

/// Average precision and largest F-score of the sequence in which frame f occurs weights[f] times;
/// `frames` by setting.
std::vector<double> summaryOf(const std::vector<std::vector<Classification>>& frames,
                              const std::vector<std::uint32_t>& weights) {
  std::vector<Classification> counts;
  counts.reserve(frames.size());
  for (const std::vector<Classification>& setting : frames) {
    counts.push_back(weightedSum(setting, weights));
  }
  const HeatmapSummary summary = summarizeHeatmap(counts);
  return {summary.average_precision, summary.max_f_score};
}

std::vector<PublishedEntry> curveEntries(const HeatmapMetrics& metrics,
                                         const EvaluateOptions& options) {
  std::vector<std::vector<Classification>> frames;  // by setting
  for (std::size_t setting = 0; setting < metrics.settings(); ++setting) {
    frames.push_back(metrics.frameClassifications(setting));
  }
  const std::vector<std::uint32_t> once(metrics.frames(), 1);
  const std::vector<double> values = summaryOf(frames, once);
  const std::vector<ConfidenceInterval> intervals = intervalsFor(
      options, metrics.frames(),
      [&frames](const std::vector<std::uint32_t>& weights) { return summaryOf(frames, weights); });
  // Thresholds fall, so the last setting has all lines that any has.
  const std::string undefined =
      whyUndefined(weightedSum(frames.back(), once),
                   {"no line has a score above a threshold", detectionWords().nothing_true});
  PublishedEntry curve;
  curve.name = "pr_curve";
  PrecisionRecallCurve points = metrics.curve();
  curve.value = Curve{std::move(points.recall), std::move(points.precision)};
  std::vector<PublishedEntry> entries = {std::move(curve)};
  const std::vector<std::string> names = {"average_precision", "max_fscore"};
  for (std::size_t index = 0; index < names.size(); ++index) {
    PublishedEntry entry;
    entry.name = names[index];
    entry.value = values[index];
    entry.undefined = undefined;
    if (!intervals.empty()) {
      entry.confidence_interval = intervals[index];
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace

int evaluateHeatmap(const std::vector<std::string>& arguments) {
  Request request;
  if (!readRequest(arguments, &request)) {
    return kExitDone;
  }
  HeatmapOptions options;
  if (!request.folders.score_thresholds.empty()) {
    options.score_thresholds = readNumbers(request.folders.score_thresholds);
  }
  const HeatmapMetrics metrics = measure(request, HeatmapMetrics(options));
  deliverResults(request.common, !request.folders.scored()
                                     ? classificationEntries({}, metrics.frameClassifications(),
                                                             detectionWords(), request.common)
                                     : curveEntries(metrics, request.common));
  return kExitDone;
}

}  // namespace evolin::cli
