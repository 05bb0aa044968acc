// Ranges and names of what an evaluation can be told.
#include "evolin_ros/evaluation/evaluation_settings.h"

#include <cstdint>
#include <limits>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

constexpr double kLargest = 1e6;

void readVectorized(ParameterReader* reader, const std::string& owner, PassOptions* pass) {
  VectorizedOptions& vectorized = pass->evaluation.vectorized;
  std::string protocol = toString(vectorized.protocol);
  reader->read("protocol", &protocol, {"evolin", "paper"});
  reader->read("distance_thresholds", &vectorized.distance_thresholds,
               std::numeric_limits<double>::min(), 1e9);
  vectorized.protocol = parseProtocol(protocol);
  const std::size_t most = VectorizedMetrics::kMaxSettings / vectorized.distances.size();
  if (vectorized.distance_thresholds.size() > most) {
    throw ConfigError(owner, "distance_thresholds",
                      "expected at most " + std::to_string(most) + " numbers, got " +
                          std::to_string(vectorized.distance_thresholds.size()));
  }
}

void readFamilies(ParameterReader* reader, const std::string& owner, PassOptions* pass) {
  std::vector<std::string> metrics;
  std::string names;
  for (const MetricFamily family : pass->families) {
    metrics.push_back(toString(family));
    names += (names.empty() ? "" : ", ") + metrics.back();
  }
  reader->read("metrics", &metrics);
  if (metrics.empty()) {
    throw ConfigError(owner, "metrics", "got an empty list, expected at least one of " + names);
  }
  pass->families.clear();
  for (const std::string& name : metrics) {
    try {
      pass->families.insert(parseMetricFamily(name));
    } catch (const Error& error) {
      throw ConfigError(owner, "metrics", error.what());
    }
  }
}

/// After readVectorized(), whose protocol and thresholds hold here, too.
void readMotion(ParameterReader* reader, const std::string& owner, PassOptions* pass) {
  MotionOptions& motion = pass->motion;
  std::string strategy = toString(motion.pose_method.strategy);
  double max_time_difference = toSeconds(motion.max_time_difference);
  PoseErrorOptions& pose_errors = pass->evaluation.pose_errors;
  int pose_seed = static_cast<int>(motion.pose_method.seed);
  int best_lines = static_cast<int>(motion.best_localization.count);
  int depth_buffer = static_cast<int>(motion.depth_buffer);
  reader->read("repeatability_steps", &motion.repeatabilities.frame_steps, 1, 100000);
  reader->read("repeatability_score_thresholds", &motion.repeatability_score_thresholds, -1e300,
               1e300, ParameterReader::EmptyList::kAccepted);
  reader->read("pose_strategy", &strategy, {"evolin", "robust"});
  reader->read("pose_seed", &pose_seed, 0, std::numeric_limits<int>::max());
  reader->read("success_rotation", &pose_errors.success_rotation, 0, 180);
  reader->read("success_translation", &pose_errors.success_translation, 0, kLargest);
  reader->read("one_to_one_distance", &motion.one_to_one.max_distance, 1e-6, 1e6);
  reader->read("one_to_one_angle", &motion.one_to_one.max_angle, 1e-6, 90);
  reader->read("one_to_one_overlap", &motion.one_to_one.min_overlap, 0, 1);
  reader->read("best_lines", &best_lines, 1, 1000000);
  reader->read("auc_thresholds", &pass->auc_thresholds, 1e-6, 180);
  reader->read("max_time_difference", &max_time_difference, 0, 10);
  reader->read("depth_buffer", &depth_buffer, 1, 100000);
  const VectorizedOptions& vectorized = pass->evaluation.vectorized;
  motion.repeatabilities.protocol = vectorized.protocol;
  motion.repeatabilities.distance_thresholds = vectorized.distance_thresholds;
  try {
    RepeatabilityMetrics checked(motion.repeatabilities);
  } catch (const Error& error) {
    throw ConfigError(owner, "repeatability_steps", error.what());
  }
  motion.pose_method.protocol = vectorized.protocol;
  motion.pose_method.strategy = parsePoseStrategy(strategy);
  motion.pose_method.seed = static_cast<std::uint64_t>(pose_seed);
  motion.best_localization.count = static_cast<std::size_t>(best_lines);
  motion.max_time_difference = fromSeconds(max_time_difference);
  motion.depth_buffer = static_cast<std::size_t>(depth_buffer);
}

void readBootstrap(ParameterReader* reader, BootstrapOptions* bootstrap) {
  int seed = static_cast<int>(bootstrap->seed);
  reader->read("bootstrap", &bootstrap->resamples, 0, 10000000);
  reader->read("bootstrap_block", &bootstrap->block_length, 0, 1000000000);
  reader->read("bootstrap_seed", &seed, 0, std::numeric_limits<int>::max());
  bootstrap->seed = static_cast<std::uint64_t>(seed);
}

}  // namespace

EvaluationSettings readEvaluationSettings(ParameterReader* reader, const std::string& owner,
                                          double heatmap_budget) {
  EvaluationSettings settings;
  PassOptions& pass = settings.pass;
  int buffer = static_cast<int>(pass.buffer);
  std::string matches_from = "topic";
  readFamilies(reader, owner, &pass);
  readVectorized(reader, owner, &pass);
  reader->read("frame_step", &pass.frame_step, 1, 100000);
  reader->read("matches_from", &matches_from, {"topic", "ids"});
  reader->read("buffer", &buffer, 2, 1000000);
  readMotion(reader, owner, &pass);
  reader->read("carry_over_gate", &pass.evaluation.carry_over_gate, 1e-6, 1e6);
  reader->read("heatmap_score_thresholds", &pass.evaluation.heatmap.score_thresholds, -1e300, 1e300,
               ParameterReader::EmptyList::kAccepted);
  reader->read("heatmap_budget", &heatmap_budget, 0, kLargest);
  readBootstrap(reader, &settings.bootstrap);
  if (heatmap_budget > 0) {
    pass.evaluation.heatmap.frame_budget = heatmap_budget;
  }
  pass.matches_from_ids = matches_from == "ids";
  pass.buffer = static_cast<std::size_t>(buffer);
  return settings;
}

}  // namespace evolin
