// `evolin evaluate vectorized`.
#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <iterator>
#include <limits>

#include "classification_entries.h"
#include "detection_inputs.h"
#include "evaluate_families.h"
#include "evaluate_options.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/resampled_precision.h"
#include "evolin_ros/metrics/vectorized.h"
#include "options.h"
#include "parallel.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Scores detected lines against true lines as vectors: precision, recall, F-score and, with "
    "scores, average precision and precision-recall curves, for two distances in pixels of images "
    "scaled to 128 x 128.\n\n"
    "Usage: evolin evaluate vectorized --pred-lines DIR --gt-lines DIR --imgs DIR [OPTIONS]";

struct Request {
  DetectionFolders folders;
  std::vector<double> distance_thresholds = VectorizedOptions().distance_thresholds;
  EvaluateOptions common;
};

/// False when only help was wanted.
bool readRequest(const std::vector<std::string>& arguments, Request* request) {
  std::string thresholds;
  for (const double threshold : request->distance_thresholds) {
    thresholds += (thresholds.empty() ? "" : " ") + formatDouble(threshold);
  }
  po::options_description description("Options");
  addDetectionOptions("text file of numbers; each gives figures of the lines with a higher score",
                      &request->folders, &description);
  description.add_options()(
      "distance-thresholds,d",
      po::value(&request->distance_thresholds)
          ->value_name("PX...")
          ->multitoken()
          ->default_value(request->distance_thresholds, thresholds),
      "largest distance of a right line, in scaled pixels; several may follow");
  addEvaluateOptions("vectorized_classification_metrics.json", &request->common, &description);
  if (!parseOptions(kUsage, description, arguments)) {
    return false;
  }
  checkEvaluateOptions(request->common);
  if (!request->folders.score_thresholds.empty() && !request->folders.scored()) {
    throw UsageError(
        "--score-thresholds needs --scores: without scores there is nothing to filter");
  }
  return true;
}

VectorizedMetrics makeMetrics(const Request& request) {
  VectorizedOptions options;
  options.protocol = protocolOf(request.common);
  options.distance_thresholds = request.distance_thresholds;
  try {
    return VectorizedMetrics(options);
  } catch (const Error& error) {
    throw UsageError(std::string("--distance-thresholds: ") + error.what());
  }
}

/// Reads and scores all frames, spread over threads.
VectorizedMetrics measure(const Request& request) {
  const VectorizedMetrics empty = makeMetrics(request);
  const std::vector<DetectionFiles> frames = listDetectionFiles(request.folders);
  const int workers = threadsFor(request.common, frames.size());
  std::vector<VectorizedMetrics> parts(static_cast<std::size_t>(workers), empty);
  forEachTask(frames.size(), workers, [&](std::size_t task, std::size_t worker) {
    const DetectionFiles& frame = frames[task];
    try {
      parts[worker].addFrame(static_cast<std::uint32_t>(task), frame.stem, frame.readSize(),
                             frame.readPredicted(), frame.readGroundTruth(),
                             request.folders.scored());
    } catch (const GroundTruthError& error) {
      throw frame.locate(error);
    }
  });
  VectorizedMetrics metrics = empty;
  for (const VectorizedMetrics& part : parts) {
    metrics.merge(part);
  }
  return metrics;
}

PublishedEntry entryFor(const std::string& name, const VectorizedSetting& setting) {
  PublishedEntry entry;
  entry.name = name;
  entry.distance = toString(setting.distance);
  entry.distance_threshold = setting.threshold;
  return entry;
}

/// Lines may be there and yet not count.
ClassificationWords wordsFor(const VectorizedMetrics& metrics) {
  ClassificationWords words = detectionWords();
  if (metrics.dropped() > 0) {
    words.nothing_predicted = "the protocol drops all " + std::to_string(metrics.dropped()) +
                              " detected lines (see docs/METRICS.md)";
  }
  return words;
}

double orNan(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

void addRankingEntries(const VectorizedMetrics& metrics, const EvaluateOptions& options,
                       std::vector<PublishedEntry>* entries) {
  const ScoreRanking ranking = metrics.ranking();
  const std::vector<std::optional<double>> values = ranking.averagePrecisions();
  ResampledPrecision resampled(ranking);
  const std::vector<ConfidenceInterval> intervals =
      intervalsForMany(options, metrics.frames(),
                       [&resampled](const std::vector<std::vector<std::uint32_t>>& resamples) {
                         std::vector<std::vector<double>> rows;
                         for (const auto& precisions : resampled.averagePrecisions(resamples)) {
                           rows.emplace_back();
                           std::transform(precisions.begin(), precisions.end(),
                                          std::back_inserter(rows.back()), orNan);
                         }
                         return rows;
                       });
  for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
    PublishedEntry area = entryFor("average_precision", metrics.settings()[setting]);
    area.value = orNan(values[setting]);
    area.undefined = whyUndefined(metrics.classification(setting), wordsFor(metrics));
    if (!intervals.empty()) {
      area.confidence_interval = intervals[setting];
    }
    entries->push_back(area);
    PublishedEntry curve = entryFor("pr_curve", metrics.settings()[setting]);
    PrecisionRecallCurve points = ranking.curve(setting);
    curve.value = Curve{std::move(points.recall), std::move(points.precision)};
    entries->push_back(std::move(curve));
  }
}

void addClassificationEntries(const VectorizedMetrics& metrics,
                              const std::optional<double>& score_threshold,
                              const EvaluateOptions& options,
                              std::vector<PublishedEntry>* entries) {
  ClassificationWords words = wordsFor(metrics);
  if (score_threshold) {
    words.nothing_predicted =
        metrics.dropped() == 0 ? "no line has a score above the threshold"
                               : "no line that the protocol keeps has a score above the threshold";
  }
  for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
    PublishedEntry prototype = entryFor("", metrics.settings()[setting]);
    prototype.score_threshold = score_threshold;
    const std::vector<Classification> frames = metrics.frameClassifications(
        setting, score_threshold.value_or(-std::numeric_limits<double>::infinity()));
    for (PublishedEntry& entry : classificationEntries(prototype, frames, words, options)) {
      entries->push_back(std::move(entry));
    }
  }
}

}  // namespace

int evaluateVectorized(const std::vector<std::string>& arguments) {
  Request request;
  if (!readRequest(arguments, &request)) {
    return kExitDone;
  }
  std::vector<double> score_thresholds;
  if (!request.folders.score_thresholds.empty()) {
    score_thresholds = readNumbers(request.folders.score_thresholds);
  }
  const VectorizedMetrics metrics = measure(request);
  std::vector<PublishedEntry> entries;
  if (!request.folders.scored()) {
    addClassificationEntries(metrics, std::nullopt, request.common, &entries);
  } else {
    addRankingEntries(metrics, request.common, &entries);
    for (const double threshold : score_thresholds) {
      addClassificationEntries(metrics, threshold, request.common, &entries);
    }
  }
  deliverResults(request.common, entries);
  return kExitDone;
}

}  // namespace evolin::cli
