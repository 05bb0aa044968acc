// Ranges and names of the evaluator's parameters.
#include "evaluator_options.h"

#include <cstdint>
#include <limits>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin::ros_shell {

namespace {

/// Of these lists an empty one says that there are none, as its absence does.
YAML::Node withoutEmptyThresholds(const YAML::Node& parameters) {
  if (!parameters.IsMap()) {
    return parameters;
  }
  YAML::Node rest(YAML::NodeType::Map);
  for (const auto& entry : parameters) {
    const std::string name = entry.first.Scalar();
    const bool may_be_empty =
        name == "heatmap_score_thresholds" || name == "repeatability_score_thresholds";
    if (!may_be_empty || !entry.second.IsSequence() || entry.second.size() > 0) {
      rest[name] = entry.second;
    }
  }
  return rest;
}

}  // namespace

EvaluatorOptions readEvaluatorOptions(const YAML::Node& parameters, const std::string& owner) {
  constexpr double kLongest = 1e6;
  EvaluatorOptions options;
  VectorizedOptions& vectorized = options.pass.evaluation.vectorized;
  std::string protocol = toString(vectorized.protocol);
  int buffer = static_cast<int>(options.pass.buffer);
  MotionOptions& motion = options.pass.motion;
  std::vector<std::string> metrics;
  std::string names;
  for (const MetricFamily family : options.pass.families) {
    metrics.push_back(toString(family));
    names += (names.empty() ? "" : ", ") + metrics.back();
  }
  std::string strategy = toString(motion.pose_method.strategy);
  std::string pose_from = "topic";
  std::string matches_from = "topic";
  double max_time_difference = toSeconds(motion.max_time_difference);
  double heatmap_budget = 1;
  PoseErrorOptions& pose_errors = options.pass.evaluation.pose_errors;
  int pose_seed = static_cast<int>(motion.pose_method.seed);
  int bootstrap_seed = static_cast<int>(options.bootstrap.seed);
  int best_lines = static_cast<int>(motion.best_localization.count);
  int depth_buffer = static_cast<int>(motion.depth_buffer);
  ParameterReader reader(withoutEmptyThresholds(parameters), owner);
  reader.read("metrics", &metrics);
  reader.read("protocol", &protocol, {"evolin", "paper"});
  reader.read("distance_thresholds", &vectorized.distance_thresholds,
              std::numeric_limits<double>::min(), 1e9);
  reader.read("frame_step", &options.pass.frame_step, 1, 100000);
  reader.read("matches_from", &matches_from, {"topic", "ids"});
  reader.read("buffer", &buffer, 2, 1000000);
  reader.read("repeatability_steps", &motion.repeatabilities.frame_steps, 1, 100000);
  reader.read("repeatability_score_thresholds", &motion.repeatability_score_thresholds, -1e300,
              1e300);
  reader.read("pose_strategy", &strategy, {"evolin", "robust"});
  reader.read("pose_seed", &pose_seed, 0, std::numeric_limits<int>::max());
  reader.read("success_rotation", &pose_errors.success_rotation, 0, 180);
  reader.read("success_translation", &pose_errors.success_translation, 0, kLongest);
  reader.read("one_to_one_distance", &motion.one_to_one.max_distance, 1e-6, 1e6);
  reader.read("one_to_one_angle", &motion.one_to_one.max_angle, 1e-6, 90);
  reader.read("one_to_one_overlap", &motion.one_to_one.min_overlap, 0, 1);
  reader.read("best_lines", &best_lines, 1, 1000000);
  reader.read("auc_thresholds", &options.pass.auc_thresholds, 1e-6, 180);
  reader.read("carry_over_gate", &options.pass.evaluation.carry_over_gate, 1e-6, 1e6);
  reader.read("heatmap_score_thresholds", &options.pass.evaluation.heatmap.score_thresholds, -1e300,
              1e300);
  reader.read("heatmap_budget", &heatmap_budget, 0, kLongest);
  reader.read("task_queue", &options.task_queue, 1, 1000000);
  reader.read("max_time_difference", &max_time_difference, 0, 10);
  reader.read("depth_buffer", &depth_buffer, 1, 100000);
  reader.read("depth_factor", &options.depth_factor, 1e-6, 1e9);
  reader.read("pose_from", &pose_from, {"topic", "tf"});
  reader.read("world_frame", &options.world_frame);
  reader.read("output_dir", &options.output_dir);
  reader.read("save_period", &options.save_period, 0.01, kLongest);
  reader.read("idle_timeout", &options.idle_timeout, 0, kLongest);
  reader.read("drain_timeout", &options.drain_timeout, 0, kLongest);
  reader.read("warn_after", &options.warn_after, 0, kLongest);
  reader.read("bootstrap", &options.bootstrap.resamples, 0, 10000000);
  reader.read("bootstrap_block", &options.bootstrap.block_length, 0, 1000000000);
  reader.read("bootstrap_seed", &bootstrap_seed, 0, std::numeric_limits<int>::max());
  reader.read("record_parameters", &options.record_parameters);
  options.health = readHealthLimits(&reader, owner);
  // Set by the player: name, size and hash of the bag, for the report's provenance.
  reader.readMap("input");
  reader.finish();
  vectorized.protocol = parseProtocol(protocol);
  if (metrics.empty()) {
    throw ConfigError(owner, "metrics", "got an empty list, expected at least one of " + names);
  }
  options.pass.families.clear();
  for (const std::string& name : metrics) {
    try {
      options.pass.families.insert(parseMetricFamily(name));
    } catch (const Error& error) {
      throw ConfigError(owner, "metrics", error.what());
    }
  }
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
  options.bootstrap.seed = static_cast<std::uint64_t>(bootstrap_seed);
  motion.best_localization.count = static_cast<std::size_t>(best_lines);
  if (heatmap_budget > 0) {
    options.pass.evaluation.heatmap.frame_budget = heatmap_budget;
  }
  motion.max_time_difference = fromSeconds(max_time_difference);
  motion.depth_buffer = static_cast<std::size_t>(depth_buffer);
  options.pose_from =
      pose_from == "tf" ? EvaluatorOptions::PoseFrom::kTf : EvaluatorOptions::PoseFrom::kTopic;
  options.pass.matches_from_ids = matches_from == "ids";
  options.pass.buffer = static_cast<std::size_t>(buffer);
  const std::size_t most = VectorizedMetrics::kMaxSettings / vectorized.distances.size();
  if (vectorized.distance_thresholds.size() > most) {
    throw ConfigError(owner, "distance_thresholds",
                      "expected at most " + std::to_string(most) + " numbers, got " +
                          std::to_string(vectorized.distance_thresholds.size()));
  }
  return options;
}

}  // namespace evolin::ros_shell
