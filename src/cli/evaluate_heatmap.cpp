// `evolin evaluate heatmap`.
#include <utility>

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
    parts[worker].addFrame(static_cast<std::uint32_t>(task), frame.stem, frame.readSize(),
                           frame.readPredicted(), frame.readGroundTruth());
  });
  HeatmapMetrics metrics = empty;
  for (const HeatmapMetrics& part : parts) {
    metrics.merge(part);
  }
  return metrics;
}

/// One entry a name, the figures that `figuresOf` gives for one weight a frame.
template <typename FiguresOf>
std::vector<PublishedEntry> entriesFor(const std::vector<std::string>& names,
                                       const EvaluateOptions& options, std::size_t frames,
                                       const FiguresOf& figuresOf) {
  const std::vector<double> values = figuresOf(std::vector<std::uint32_t>(frames, 1));
  const std::vector<ConfidenceInterval> intervals = intervalsFor(options, frames, figuresOf);
  std::vector<PublishedEntry> entries(names.size());
  for (std::size_t index = 0; index < names.size(); ++index) {
    entries[index].name = names[index];
    entries[index].value = values[index];
    if (!intervals.empty()) {
      entries[index].confidence_interval = intervals[index];
    }
  }
  return entries;
}

std::vector<PublishedEntry> classificationEntries(const HeatmapMetrics& metrics,
                                                  const EvaluateOptions& options) {
  const std::vector<Classification> frames = metrics.frameClassifications();
  return entriesFor(
      {"precision", "recall", "fscore"}, options, frames.size(),
      [&frames](const std::vector<std::uint32_t>& weights) {
        const Classification counts = weightedSum(frames, weights);
        return std::vector<double>{counts.precision(), counts.recall(), counts.fScore()};
      });
}

std::vector<PublishedEntry> curveEntries(const HeatmapMetrics& metrics,
                                         const EvaluateOptions& options) {
  std::vector<std::vector<Classification>> frames;  // by setting
  for (std::size_t setting = 0; setting < metrics.settings(); ++setting) {
    frames.push_back(metrics.frameClassifications(setting));
  }
  PublishedEntry curve;
  curve.name = "pr_curve";
  PrecisionRecallCurve points = metrics.curve();
  curve.value = Curve{std::move(points.recall), std::move(points.precision)};
  std::vector<PublishedEntry> entries = {std::move(curve)};
  for (PublishedEntry& entry :
       entriesFor({"average_precision", "max_fscore"}, options, metrics.frames(),
                  [&frames](const std::vector<std::uint32_t>& weights) {
                    std::vector<Classification> counts;
                    counts.reserve(frames.size());
                    for (const std::vector<Classification>& setting : frames) {
                      counts.push_back(weightedSum(setting, weights));
                    }
                    const HeatmapSummary summary = summarizeHeatmap(counts);
                    return std::vector<double>{summary.average_precision, summary.max_f_score};
                  })) {
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
                                     ? classificationEntries(metrics, request.common)
                                     : curveEntries(metrics, request.common));
  return kExitDone;
}

}  // namespace evolin::cli
