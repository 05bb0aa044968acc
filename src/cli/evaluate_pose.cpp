// `evolin evaluate pose`.
#include <boost/program_options/value_semantic.hpp>
#include <cmath>
#include <iostream>

#include "evaluate_families.h"
#include "evaluate_options.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/evaluation/pose_task.h"
#include "evolin_ros/metrics/pose_error.h"
#include "evolin_ros/metrics/resampled_pose_errors.h"
#include "options.h"
#include "parallel.h"
#include "pose_inputs.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Estimates the motion between frames from matched lines with depth, in both directions, and "
    "scores it: medians of rotation error and translation angle (degrees) and of translation error "
    "(metres), area under the cumulative curve of angles. The frames step is the number of frames "
    "less the number of association files.\n\n"
    "Usage: evolin evaluate pose --lines DIR --associations DIR --depths DIR --poses FILE "
    "--depth-associations FILE --calibration-matrix FILE [OPTIONS]";

struct Request {
  FrameFolders folders;
  std::string associations;
  std::string calibration_matrix;
  std::vector<double> thresholds = {1, 3, 5, 10};
  double depth_factor = Camera().depth_factor;
  std::string strategy = toString(PoseStrategy::kEvolin);
  std::uint64_t seed = PoseMethodOptions().seed;
  bool statistics = false;
  EvaluateOptions common;
};

void addOptions(Request* request, po::options_description* description) {
  auto add = description->add_options();
  add("lines,l", po::value(&request->folders.lines)->value_name("DIR")->required(),
      "lines, one CSV (rows x1,y1,x2,y2 in pixels) a frame, frames in order of names");
  add("associations,a", po::value(&request->associations)->value_name("DIR")->required(),
      "matches, one CSV (rows i,j of line indices) a pair of frames, pairs in order of names");
  add("depths,d", po::value(&request->folders.depths)->value_name("DIR")->required(),
      "depth images, 16 bit, in order of names");
  add("poses,p", po::value(&request->folders.poses)->value_name("FILE")->required(),
      "camera poses in TUM's form, camera to world, a row a line file, or a row each of "
      "--depth-associations; the first column is not looked at");
  add("depth-associations,A",
      po::value(&request->folders.depth_associations)->value_name("FILE")->required(),
      "rows of image index and depth index, both from 0");
  add("calibration-matrix,c",
      po::value(&request->calibration_matrix)->value_name("FILE")->required(),
      "3 x 3 camera matrix in pixels");
  add("pose-error-auc-thresholds,t",
      po::value(&request->thresholds)
          ->value_name("DEG...")
          ->multitoken()
          ->default_value(request->thresholds, "1 3 5 10"),
      "ends of the cumulative curve in degrees; several may follow");
  add("pose-offset", po::value(&request->folders.pose_offset)->value_name("N")->default_value(0),
      "image i takes pose row i + N; pairs of an image that gets none are left out and counted "
      "(ICL-NUIM: -1 is the true pairing, 0 the published one)");
  add("depth-factor",
      po::value(&request->depth_factor)
          ->value_name("X")
          ->default_value(request->depth_factor, formatDouble(request->depth_factor)),
      "stored depth units per metre");
  add("strategy",
      po::value(&request->strategy)->value_name("evolin|robust")->default_value(request->strategy),
      "estimate as the published implementation does, or by consensus and refinement");
  add("seed", po::value(&request->seed)->value_name("N")->default_value(request->seed),
      "seed of the sampling of --strategy robust");
  add("statistics", po::bool_switch(&request->statistics),
      "add what the published scripts do not have: area under the curve of the larger angle, "
      "success rate (1 degree and 0.05 m), seven statistics of each error over the pairs found, "
      "and counts of pairs");
}

/// False when only help was wanted.
bool readRequest(const std::vector<std::string>& arguments, Request* request) {
  po::options_description description("Options");
  addOptions(request, &description);
  addEvaluateOptions("pose_errors.json", &request->common, &description);
  if (!parseOptions(kUsage, description, arguments)) {
    return false;
  }
  checkEvaluateOptions(request->common);
  for (const double threshold : request->thresholds) {
    if (!(threshold > 0) || !std::isfinite(threshold)) {
      throw UsageError("--pose-error-auc-thresholds " + formatDouble(threshold) +
                       ": expected a number of degrees above 0");
    }
  }
  if (!(request->depth_factor > 0) || !std::isfinite(request->depth_factor)) {
    throw UsageError("--depth-factor " + formatDouble(request->depth_factor) +
                     ": expected a positive number of stored units per metre");
  }
  try {
    parsePoseStrategy(request->strategy);
  } catch (const Error& error) {
    throw UsageError(std::string("--strategy: ") + error.what());
  }
  return true;
}

/// What all pairs share.
struct Setup {
  PoseMethod method;
  Camera camera;
  DepthImages depths;
};

LiftedLines liftFrame(const Setup& setup, const FrameFiles& frame) {
  return liftEndpoints(frame.stem, readLinesCsv(frame.lines), setup.depths.read(frame),
                       setup.camera, setup.method.endpoints());
}

PosePair measurePair(const Setup& setup, const FrameFiles& first, const FrameFiles& second,
                     const std::filesystem::path& associations) {
  const LiftedLines first_lines = liftFrame(setup, first);
  const LiftedLines second_lines = liftFrame(setup, second);
  const IndexPairs matches = readIndexPairsCsv(associations);
  for (std::size_t row = 0; row < matches.size(); ++row) {
    const auto check = [&](std::int64_t index, const LiftedLines& lines, const FrameFiles& frame,
                           const std::string& which) {
      if (static_cast<std::size_t>(index) >= lines.size()) {
        throw ParseError(associations.string(), static_cast<int>(row) + 1,
                         "names line " + std::to_string(index) + " of the " + which +
                             " frame, expected 0 to " + std::to_string(lines.size()) +
                             " exclusive (the lines of " + frame.lines.string() + ")");
      }
    };
    check(matches[row].first, first_lines, first, "first");
    check(matches[row].second, second_lines, second, "second");
  }
  PoseTask task;
  task.matches = liftedMatches(first_lines, second_lines, matches);
  task.camera = setup.camera;
  task.truth = relativeMotion(*first.pose, *second.pose);
  return runPoseTask(task, setup.method).pair;
}

/// Entries of one frames step, in the published order.
class Entries {
 public:
  explicit Entries(std::size_t step) : step_(static_cast<std::int64_t>(step)) {}

  PublishedEntry& add(const std::string& name, double value) {
    PublishedEntry entry;
    entry.name = name;
    entry.frames_step = step_;
    entry.value = value;
    list_.push_back(std::move(entry));
    return list_.back();
  }

  const std::vector<PublishedEntry>& list() const { return list_; }

 private:
  std::int64_t step_;
  std::vector<PublishedEntry> list_;
};

void addPublished(const Request& request, const PoseErrorMetrics& metrics, Entries* entries) {
  const auto figures_of = [](const PoseErrors& medians) {
    return std::vector<double>{medians.rotation, medians.translation_angle, medians.translation};
  };
  const std::vector<double> medians = figures_of(metrics.medians());
  const ResampledPoseErrors resampled = metrics.resampled();
  const std::vector<ConfidenceInterval> intervals =
      intervalsFor(request.common, metrics.pairs(), [&](const std::vector<std::uint32_t>& weights) {
        return figures_of(resampled.medians(weights));
      });
  const std::vector<std::string> names = {"median_angular_rotation_error",
                                          "median_angular_translation_error",
                                          "median_absolute_translation_error"};
  for (std::size_t index = 0; index < names.size(); ++index) {
    PublishedEntry& entry = entries->add(names[index], medians[index]);
    if (!intervals.empty()) {
      entry.confidence_interval = intervals[index];
    }
  }
  for (const double threshold : request.thresholds) {
    entries->add("pose_error_auc", metrics.areaUnderCurve(threshold, AngleRule::kSmaller))
        .threshold = threshold;
  }
}

void addStatistics(const Request& request, const PoseErrorMetrics& metrics, Entries* entries) {
  for (const double threshold : request.thresholds) {
    entries->add("auc_max", metrics.areaUnderCurve(threshold, AngleRule::kLarger)).threshold =
        threshold;
  }
  const std::vector<std::pair<std::string, ErrorStatistics>> groups = {
      {"angular_rotation_error", metrics.rotationStatistics()},
      {"angular_translation_error", metrics.translationAngleStatistics()},
      {"absolute_translation_error", metrics.translationStatistics()}};
  const std::string nothing_found = metrics.failed() == metrics.pairs() ? "no pose was found" : "";
  for (const auto& [name, statistics] : groups) {
    const std::vector<std::pair<std::string, double>> figures = {
        {"_rmse", statistics.rmse}, {"_mean", statistics.mean}, {"_median", statistics.median},
        {"_std", statistics.std},   {"_min", statistics.min},   {"_max", statistics.max},
        {"_sse", statistics.sse}};
    for (const auto& [suffix, value] : figures) {
      entries->add(name + suffix, value).undefined = nothing_found;
    }
  }
  entries->add("success_rate", metrics.successRate());
  entries->add("pairs", static_cast<double>(metrics.pairs()));
  entries->add("failed_pairs", static_cast<double>(metrics.failed()));
  entries->add("ill_conditioned_pairs", static_cast<double>(metrics.illConditioned()));
  entries->add("near_static_pairs", static_cast<double>(metrics.nearStatic()));
}

void printCoverage(const Request& request, const PoseInputs& inputs,
                   const PoseErrorMetrics& metrics) {
  std::cerr << metrics.pairs() << " pairs of frames " << inputs.step << " apart, strategy "
            << request.strategy << ", "
            << (inputs.list.by_depth_list
                    ? "row i of " + request.folders.depth_associations + " with pose row i"
                    : "image i with pose row i")
            << (request.folders.pose_offset < 0 ? " - " : " + ")
            << std::abs(request.folders.pose_offset) << ": " << metrics.failed() << " failed, "
            << metrics.illConditioned() << " ill-conditioned, " << metrics.nearStatic()
            << " moved less than 1 cm (their translation angle means little)\n";
  if (inputs.without_pose + inputs.without_depth > 0) {
    std::cerr << "left out: " << inputs.without_pose << " pairs without a pose, "
              << inputs.without_depth << " without depth\n";
  }
}

}  // namespace

int evaluatePose(const std::vector<std::string>& arguments) {
  Request request;
  if (!readRequest(arguments, &request)) {
    return kExitDone;
  }
  const Camera camera = readCalibrationMatrix(request.calibration_matrix);
  const PoseInputs inputs = listPoseInputs(request.folders, request.associations);
  const Setup setup = {
      PoseMethod({protocolOf(request.common), parsePoseStrategy(request.strategy), request.seed}),
      camera, DepthImages(inputs.list.frames, request.depth_factor)};
  std::vector<PosePair> pairs(inputs.pairs.size());
  forEachTask(pairs.size(), threadsFor(request.common, pairs.size()),
              [&](std::size_t task, std::size_t /*worker*/) {
                const PosePairFiles& pair = inputs.pairs[task];
                pairs[task] = measurePair(setup, inputs.list.frames[pair.first],
                                          inputs.list.frames[pair.second], pair.associations);
              });
  PoseErrorMetrics metrics;
  for (const PosePair& pair : pairs) {
    metrics.addPair(pair);
  }
  printCoverage(request, inputs, metrics);
  Entries entries(inputs.step);
  addPublished(request, metrics, &entries);
  if (request.statistics) {
    addStatistics(request, metrics, &entries);
  }
  deliverResults(request.common, entries.list());
  return kExitDone;
}

}  // namespace evolin::cli
