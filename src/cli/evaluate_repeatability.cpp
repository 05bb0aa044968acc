// `evolin evaluate repeatability`.
#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <cmath>
#include <cstdint>
#include <iostream>

#include "evaluate_families.h"
#include "evaluate_options.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/repeatability.h"
#include "evolin_ros/metrics/resampled_repeatability.h"
#include "frame_files.h"
#include "options.h"
#include "parallel.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Scores detected lines by whether they are found again in later frames: repeatability and "
    "localisation error, for two distances in pixels of images scaled to 128 x 128. Lines are "
    "carried from frame to frame by depth and poses.\n\n"
    "Usage: evolin evaluate repeatability --pred-lines DIR --depths DIR --poses FILE "
    "--depth-associations FILE --calibration-matrix FILE [OPTIONS]";

/// Frames that are held at once, besides one frame step.
constexpr std::size_t kChunk = 64;

struct Request {
  FrameFolders folders;
  std::string score_thresholds;  ///< file; empty: none
  std::string calibration_matrix;
  double depth_factor = Camera().depth_factor;
  RepeatabilityOptions metric;
  EvaluateOptions common;
};

template <typename Number>
std::string listOf(const std::vector<Number>& values) {
  std::string text;
  for (const Number value : values) {
    text += (text.empty() ? "" : " ") + formatDouble(value);
  }
  return text;
}

void addOptions(Request* request, po::options_description* description) {
  auto add = description->add_options();
  add("pred-lines,p", po::value(&request->folders.lines)->value_name("DIR")->required(),
      "detected lines, one CSV (rows x1,y1,x2,y2 in pixels) a frame, frames in order of names");
  add("scores,s", po::value(&request->folders.scores)->value_name("DIR"),
      "scores of the lines, one CSV (a score a row) a frame, under the same names");
  add("score-thresholds,S", po::value(&request->score_thresholds)->value_name("FILE"),
      "text file of numbers, needed with --scores; each gives figures of the lines with a higher "
      "score");
  add("depths,D", po::value(&request->folders.depths)->value_name("DIR")->required(),
      "depth images, 16 bit, in order of names");
  add("poses,P", po::value(&request->folders.poses)->value_name("FILE")->required(),
      "camera poses in TUM's form, camera to world, a row a line file, or a row each of "
      "--depth-associations; the first column is not looked at");
  add("depth-associations,a",
      po::value(&request->folders.depth_associations)->value_name("FILE")->required(),
      "rows of image index and depth index, both from 0");
  add("calibration-matrix,c",
      po::value(&request->calibration_matrix)->value_name("FILE")->required(),
      "3 x 3 camera matrix in pixels");
  add("distance-thresholds,d",
      po::value(&request->metric.distance_thresholds)
          ->value_name("PX...")
          ->multitoken()
          ->default_value(request->metric.distance_thresholds,
                          listOf(request->metric.distance_thresholds)),
      "distance below which a line is found again, in scaled pixels; several may follow");
  add("frames-steps,f",
      po::value(&request->metric.frame_steps)
          ->value_name("N...")
          ->multitoken()
          ->default_value(request->metric.frame_steps, listOf(request->metric.frame_steps)),
      "frames from the first to the second of a pair; several may follow");
  add("pose-offset", po::value(&request->folders.pose_offset)->value_name("N")->default_value(0),
      "image i takes pose row i + N; images that get none are left out and counted");
  add("depth-factor",
      po::value(&request->depth_factor)
          ->value_name("X")
          ->default_value(request->depth_factor, formatDouble(request->depth_factor)),
      "stored depth units per metre");
}

/// False when only help was wanted.
bool readRequest(const std::vector<std::string>& arguments, Request* request) {
  po::options_description description("Options");
  addOptions(request, &description);
  addEvaluateOptions("repeatability_metrics.json", &request->common, &description);
  if (!parseOptions(kUsage, description, arguments)) {
    return false;
  }
  checkEvaluateOptions(request->common);
  request->metric.protocol = protocolOf(request->common);
  if (request->folders.scores.empty() != request->score_thresholds.empty()) {
    throw UsageError(
        "--scores and --score-thresholds need each other: figures are of the lines above a score");
  }
  if (!(request->depth_factor > 0) || !std::isfinite(request->depth_factor)) {
    throw UsageError("--depth-factor " + formatDouble(request->depth_factor) +
                     ": expected a positive number of stored units per metre");
  }
  try {
    RepeatabilityMetrics checked(request->metric);
  } catch (const Error& error) {
    throw UsageError(std::string("--distance-thresholds, --frames-steps: ") + error.what());
  }
  return true;
}

/// Says on standard error what is left out; throws when a frame step is left without pairs.
void checkCoverage(const Request& request, const FrameList& list) {
  const std::vector<FrameFiles>& frames = list.frames;
  if (list.by_depth_list) {
    std::cerr << "frames are the " << frames.size() << " rows of "
              << request.folders.depth_associations << ", each with the pose of its row\n";
  }
  const auto say = [&frames](std::size_t count, const std::string& lack) {
    if (count > 0) {
      std::cerr << count << " of " << frames.size() << " frames left out: " << lack << '\n';
    }
  };
  const auto count_of = [&frames](bool (*lacks)(const FrameFiles&)) {
    return static_cast<std::size_t>(std::count_if(frames.begin(), frames.end(), lacks));
  };
  say(count_of([](const FrameFiles& frame) { return frame.depth.empty(); }),
      "no depth in " + request.folders.depth_associations);
  say(count_of([](const FrameFiles& frame) { return !frame.pose.has_value(); }),
      "no pose in " + request.folders.poses + " with --pose-offset " +
          std::to_string(request.folders.pose_offset));
  for (const int step : request.metric.frame_steps) {
    const auto distance = static_cast<std::size_t>(step);
    std::size_t pairs = 0;
    for (std::size_t index = 0; index + distance < frames.size(); ++index) {
      pairs += frames[index].usable() && frames[index + distance].usable() ? 1 : 0;
    }
    if (pairs == 0) {
      throw Error("--frames-steps " + std::to_string(step) +
                  ": no pair of frames so far apart has "
                  "depth and poses, of " +
                  std::to_string(frames.size()) + " frames in " + request.folders.lines +
                  "; expected more frames or a smaller step");
    }
  }
}

SpatialFrame readFrame(const Request& request, const Camera& camera, const DepthImages& depths,
                       const FrameFiles& source) {
  const LineSegments lines = source.scores.empty()
                                 ? readLinesCsv(source.lines)
                                 : readScoredLinesCsv(source.lines, source.scores);
  return liftLines(request.metric.protocol, source.stem, lines, depths.read(source), camera,
                   *source.pose);
}

/// All pairs of one frame step.
struct StepResult {
  std::vector<std::size_t> settings;                  ///< of the metrics, in the results' order
  std::vector<std::vector<PairRepeatability>> pairs;  ///< a result a setting
};

/// Reads and scores the sequence, spread over threads, holding a stretch of frames at a time.
std::vector<StepResult> measure(const Request& request, const RepeatabilityMetrics& metrics,
                                const std::vector<FrameFiles>& sources) {
  const Camera camera = readCalibrationMatrix(request.calibration_matrix);
  const DepthImages depths(sources, request.depth_factor);
  const std::vector<int>& steps = request.metric.frame_steps;
  const auto reach = static_cast<std::size_t>(*std::max_element(steps.begin(), steps.end()));
  struct Pair {
    std::size_t step_index;
    std::size_t first;
    std::size_t second;
  };
  std::vector<StepResult> results(steps.size());
  for (std::size_t index = 0; index < steps.size(); ++index) {
    results[index].settings = metrics.settingsOf(steps[index]);
  }
  std::vector<std::optional<SpatialFrame>> frames(sources.size());
  std::size_t ready = 0;
  for (std::size_t begin = 0; begin < sources.size(); begin += kChunk) {
    const std::size_t end = std::min(sources.size(), begin + kChunk);
    const std::size_t needed = std::min(sources.size(), end + reach);
    forEachTask(needed - ready, threadsFor(request.common, needed - ready),
                [&](std::size_t task, std::size_t /*worker*/) {
                  const std::size_t index = ready + task;
                  if (sources[index].usable()) {
                    frames[index] = readFrame(request, camera, depths, sources[index]);
                  }
                });
    ready = needed;
    std::vector<Pair> pairs;
    for (std::size_t first = begin; first < end; ++first) {
      for (std::size_t step = 0; step < steps.size(); ++step) {
        const std::size_t second = first + static_cast<std::size_t>(steps[step]);
        if (second < sources.size() && frames[first] && frames[second]) {
          pairs.push_back({step, first, second});
        }
      }
    }
    std::vector<std::vector<PairRepeatability>> measured(pairs.size());
    forEachTask(pairs.size(), threadsFor(request.common, pairs.size()),
                [&](std::size_t task, std::size_t /*worker*/) {
                  measured[task] =
                      metrics.measure(*frames[pairs[task].first], *frames[pairs[task].second]);
                });
    for (std::size_t index = 0; index < pairs.size(); ++index) {
      results[pairs[index].step_index].pairs.push_back(std::move(measured[index]));
    }
    std::fill(frames.begin() + static_cast<std::ptrdiff_t>(begin),
              frames.begin() + static_cast<std::ptrdiff_t>(end), std::nullopt);
  }
  return results;
}

PublishedEntry entryFor(const std::string& name, const RepeatabilitySetting& setting) {
  PublishedEntry entry;
  entry.name = name;
  entry.distance = toString(setting.distance);
  entry.distance_threshold = setting.distance_threshold;
  entry.score_threshold = setting.score_threshold;
  entry.frames_step = setting.frame_step;
  return entry;
}

/// Repeatability and localisation error of each of the step's settings in turn.
std::vector<ConfidenceInterval> intervalsOf(const Request& request, const StepResult& result) {
  std::vector<ResampledRepeatability> resampled;
  for (std::size_t setting = 0; setting < result.settings.size(); ++setting) {
    std::vector<PairRepeatability> pairs;
    pairs.reserve(result.pairs.size());
    for (const std::vector<PairRepeatability>& pair : result.pairs) {
      pairs.push_back(pair[setting]);
    }
    resampled.emplace_back(pairs, request.metric.protocol);
  }
  return intervalsFor(
      request.common, result.pairs.size(), [&](const std::vector<std::uint32_t>& weights) {
        std::vector<double> figures;
        for (const ResampledRepeatability& setting : resampled) {
          const RepeatabilityFigures of_setting = setting.figures(weights);
          figures.insert(figures.end(), {of_setting.repeatability, of_setting.localization_error});
        }
        return figures;
      });
}

/// Why the figures of one setting have no value; empty where they have one.
struct Undefined {
  std::string repeatability;
  std::string localization_error;
};

Undefined whyUndefined(const StepResult& result, std::size_t index) {
  std::size_t lines = 0;
  std::size_t found = 0;
  for (const std::vector<PairRepeatability>& pair : result.pairs) {
    lines += pair[index].lines;
    found += std::size_t{pair[index].forward.count} + pair[index].backward.count;
  }
  return {lines == 0 ? "no lines were detected or none has a score above the threshold" : "",
          found == 0 ? "no line was found again" : ""};
}

}  // namespace

int evaluateRepeatability(const std::vector<std::string>& arguments) {
  Request request;
  if (!readRequest(arguments, &request)) {
    return kExitDone;
  }
  if (!request.score_thresholds.empty()) {
    request.metric.score_thresholds = readNumbers(request.score_thresholds);
  }
  const FrameList list = listFrames(request.folders);
  checkCoverage(request, list);
  RepeatabilityMetrics metrics(request.metric);
  const std::vector<StepResult> results = measure(request, metrics, list.frames);

  std::vector<PublishedEntry> entries(2 * metrics.settings().size());
  for (std::size_t step = 0; step < results.size(); ++step) {
    for (const std::vector<PairRepeatability>& pair : results[step].pairs) {
      metrics.add(request.metric.frame_steps[step], pair);
    }
    const std::vector<ConfidenceInterval> intervals = intervalsOf(request, results[step]);
    for (std::size_t index = 0; index < results[step].settings.size(); ++index) {
      const std::size_t setting = results[step].settings[index];
      const RepeatabilityFigures figures = metrics.figures(setting).value();
      PublishedEntry repeatability = entryFor("repeatability", metrics.settings()[setting]);
      PublishedEntry error = entryFor("localization_error", metrics.settings()[setting]);
      const Undefined undefined = whyUndefined(results[step], index);
      repeatability.undefined = undefined.repeatability;
      error.undefined = undefined.localization_error;
      repeatability.value = figures.repeatability;
      error.value = figures.localization_error;
      if (!intervals.empty()) {
        repeatability.confidence_interval = intervals[2 * index];
        error.confidence_interval = intervals[2 * index + 1];
      }
      entries[2 * setting] = std::move(repeatability);
      entries[2 * setting + 1] = std::move(error);
    }
  }
  deliverResults(request.common, entries);
  return kExitDone;
}

}  // namespace evolin::cli
