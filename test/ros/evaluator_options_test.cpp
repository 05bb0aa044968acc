// The evaluator's parameters: defaults, ranges, and errors that name the parameter.
#include "evaluator_options.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/stream_evaluator.h"
#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

EvaluatorOptions read(const std::string& yaml) {
  return readEvaluatorOptions(YAML::Load(yaml), "/evaluator");
}

TEST(EvaluatorOptions, HaveTheDocumentedDefaults) {
  const EvaluatorOptions options = readEvaluatorOptions(YAML::Node(), "/evaluator");
  EXPECT_EQ(options.pass.evaluation.vectorized.protocol, Protocol::kEvolin);
  EXPECT_EQ(options.pass.evaluation.vectorized.distance_thresholds,
            (std::vector<double>{5, 10, 15}));
  EXPECT_EQ(options.pass.frame_step, 1);
  EXPECT_FALSE(options.pass.matches_from_ids);
  EXPECT_EQ(options.pass.buffer, 1000U);
  EXPECT_EQ(options.output_dir, "");
  EXPECT_EQ(options.save_period, 5);
  EXPECT_EQ(options.idle_timeout, 2);
  EXPECT_EQ(options.drain_timeout, 5);
  EXPECT_EQ(options.warn_after, 3);
  EXPECT_TRUE(options.record_parameters.empty());
}

YAML::Node shippedFile() {
  return YAML::LoadFile(std::string(EVOLIN_SOURCE_DIR) + "/config/evaluator.yaml");
}

/// As the message about an unknown name lists them.
std::set<std::string> knownParameters() {
  try {
    read("{no_parameter: 0}");
  } catch (const ConfigError& error) {
    const std::string head = "Known parameters: ";
    std::string list = error.what();
    list = list.substr(list.find(head) + head.size());
    std::set<std::string> names;
    for (std::size_t comma = list.find(", "); comma != std::string::npos; comma = list.find(", ")) {
      names.insert(list.substr(0, comma));
      list = list.substr(comma + 2);
    }
    names.insert(list);
    return names;
  }
  return {};
}

TEST(EvaluatorOptions, AllStandInTheShippedFile) {
  std::set<std::string> expected = knownParameters();
  ASSERT_GT(expected.size(), 30U);
  EXPECT_EQ(expected.erase("diagnostics"), 1U) << "has a file of its own";
  EXPECT_EQ(expected.erase("input"), 1U) << "is set by the player";
  std::set<std::string> shipped;
  for (const auto& entry : shippedFile()) {
    shipped.insert(entry.first.Scalar());
  }
  EXPECT_EQ(shipped, expected);
}

TEST(EvaluatorOptions, OfTheShippedFileAreTheDefaults) {
  const EvaluatorOptions shipped = readEvaluatorOptions(shippedFile(), "/evaluator");
  const EvaluatorOptions plain = readEvaluatorOptions(YAML::Node(), "/evaluator");
  const EvaluationOptions& a = shipped.pass.evaluation;
  const EvaluationOptions& b = plain.pass.evaluation;
  EXPECT_EQ(shipped.pass.families, plain.pass.families);
  EXPECT_EQ(a.vectorized.protocol, b.vectorized.protocol);
  EXPECT_EQ(a.vectorized.distance_thresholds, b.vectorized.distance_thresholds);
  EXPECT_EQ(a.heatmap.score_thresholds, b.heatmap.score_thresholds);
  EXPECT_EQ(a.heatmap.frame_budget, b.heatmap.frame_budget);
  EXPECT_EQ(a.pose_errors.success_rotation, b.pose_errors.success_rotation);
  EXPECT_EQ(a.pose_errors.success_translation, b.pose_errors.success_translation);
  EXPECT_EQ(a.carry_over_gate, b.carry_over_gate);
  EXPECT_EQ(shipped.pass.auc_thresholds, plain.pass.auc_thresholds);
  EXPECT_EQ(shipped.pass.buffer, plain.pass.buffer);
  EXPECT_EQ(shipped.pass.frame_step, plain.pass.frame_step);
  EXPECT_EQ(shipped.pass.matches_from_ids, plain.pass.matches_from_ids);
  const MotionOptions& c = shipped.pass.motion;
  const MotionOptions& d = plain.pass.motion;
  EXPECT_EQ(c.repeatabilities.frame_steps, d.repeatabilities.frame_steps);
  EXPECT_EQ(c.repeatability_score_thresholds, d.repeatability_score_thresholds);
  EXPECT_EQ(c.one_to_one.max_distance, d.one_to_one.max_distance);
  EXPECT_EQ(c.one_to_one.max_angle, d.one_to_one.max_angle);
  EXPECT_EQ(c.one_to_one.min_overlap, d.one_to_one.min_overlap);
  EXPECT_EQ(c.best_localization.count, d.best_localization.count);
  EXPECT_EQ(c.pose_method.strategy, d.pose_method.strategy);
  EXPECT_EQ(c.pose_method.seed, d.pose_method.seed);
  EXPECT_EQ(c.max_time_difference, d.max_time_difference);
  EXPECT_EQ(c.depth_buffer, d.depth_buffer);
  EXPECT_EQ(shipped.pose_from, plain.pose_from);
  EXPECT_EQ(shipped.world_frame, plain.world_frame);
  EXPECT_EQ(shipped.depth_factor, plain.depth_factor);
  EXPECT_EQ(shipped.task_queue, plain.task_queue);
  EXPECT_EQ(shipped.bootstrap.resamples, plain.bootstrap.resamples);
  EXPECT_EQ(shipped.bootstrap.block_length, plain.bootstrap.block_length);
  EXPECT_EQ(shipped.bootstrap.seed, plain.bootstrap.seed);
  EXPECT_EQ(shipped.output_dir, plain.output_dir);
  EXPECT_EQ(shipped.save_period, plain.save_period);
  EXPECT_EQ(shipped.idle_timeout, plain.idle_timeout);
  EXPECT_EQ(shipped.drain_timeout, plain.drain_timeout);
  EXPECT_EQ(shipped.warn_after, plain.warn_after);
  EXPECT_EQ(shipped.health.period, plain.health.period);
  EXPECT_EQ(shipped.record_parameters, plain.record_parameters);
}

TEST(EvaluatorOptions, ScoreThresholdsMayBeNone) {
  const EvaluatorOptions none =
      read("{heatmap_score_thresholds: [], repeatability_score_thresholds: []}");
  EXPECT_TRUE(none.pass.evaluation.heatmap.score_thresholds.empty());
  EXPECT_TRUE(none.pass.motion.repeatability_score_thresholds.empty());
}

TEST(EvaluatorOptions, AreReadOneByOne) {
  const EvaluatorOptions options = read(
      "{protocol: paper, distance_thresholds: [2.5, 7], frame_step: 10, buffer: 50,"
      " matches_from: ids,"
      " output_dir: /tmp/x, save_period: 0.5, idle_timeout: 0, drain_timeout: 9,"
      " warn_after: 0, record_parameters: [/detector, associator],"
      " input: {bag: a.bag, images: 3}}");
  EXPECT_EQ(options.pass.evaluation.vectorized.protocol, Protocol::kPaper);
  EXPECT_EQ(options.pass.evaluation.vectorized.distance_thresholds, (std::vector<double>{2.5, 7}));
  EXPECT_EQ(options.pass.frame_step, 10);
  EXPECT_TRUE(options.pass.matches_from_ids);
  EXPECT_EQ(options.pass.buffer, 50U);
  EXPECT_EQ(options.output_dir, "/tmp/x");
  EXPECT_EQ(options.save_period, 0.5);
  EXPECT_EQ(options.idle_timeout, 0);
  EXPECT_EQ(options.drain_timeout, 9);
  EXPECT_EQ(options.warn_after, 0);
  EXPECT_EQ(options.record_parameters, (std::vector<std::string>{"/detector", "associator"}));
}

TEST(EvaluatorOptions, OfPosesAndRepeatabilityReachTheirMetrics) {
  const EvaluatorOptions options = read(
      "{success_rotation: 2, success_translation: 0.1, pose_seed: 7, one_to_one_distance: 3,"
      " one_to_one_angle: 10, one_to_one_overlap: 0.25, best_lines: 20, carry_over_gate: 4,"
      " repeatability_score_thresholds: [0.5, 0.9]}");
  EXPECT_EQ(options.pass.evaluation.pose_errors.success_rotation, 2);
  EXPECT_EQ(options.pass.evaluation.pose_errors.success_translation, 0.1);
  EXPECT_EQ(options.pass.evaluation.carry_over_gate, 4);
  const MotionOptions& motion = options.pass.motion;
  EXPECT_EQ(motion.pose_method.seed, 7U);
  EXPECT_EQ(motion.one_to_one.max_distance, 3);
  EXPECT_EQ(motion.one_to_one.max_angle, 10);
  EXPECT_EQ(motion.one_to_one.min_overlap, 0.25);
  EXPECT_EQ(motion.best_localization.count, 20U);
  EXPECT_EQ(motion.repeatability_score_thresholds, (std::vector<double>{0.5, 0.9}));
}

TEST(EvaluatorOptions, OfTheBootstrapMayBeNone) {
  EXPECT_EQ(read("{}").bootstrap.resamples, 1000);
  const BootstrapOptions options =
      read("{bootstrap: 0, bootstrap_block: 5, bootstrap_seed: 9}").bootstrap;
  EXPECT_EQ(options.resamples, 0);
  EXPECT_EQ(options.block_length, 5);
  EXPECT_EQ(options.seed, 9U);
}

TEST(EvaluatorOptions, RefuseByNameWithValueAndRange) {
  const auto expect_refusal = [](const std::string& yaml, const std::string& key,
                                 const std::string& part) {
    test::expectError<ConfigError>([&] { read(yaml); }, {"/evaluator", "'" + key + "'", part});
  };
  expect_refusal("protocol: evolution", "protocol", "evolin, paper");
  expect_refusal("distance_thresholds: [5, 0]", "distance_thresholds", "'0'");
  expect_refusal("distance_thresholds: [.nan]", "distance_thresholds", "nan");
  expect_refusal("distance_thresholds: []", "distance_thresholds", "got an empty list");
  expect_refusal("distance_thresholds: 5", "distance_thresholds", "list");
  expect_refusal("metrics: []", "metrics", "detection, heatmap, repeatability");
  expect_refusal("metrics: [detections]", "metrics", "detections");
  expect_refusal("success_rotation: -1", "success_rotation", "from 0 to 180");
  expect_refusal("success_translation: .nan", "success_translation", "nan");
  expect_refusal("pose_seed: -1", "pose_seed", "'-1'");
  expect_refusal("one_to_one_distance: 0", "one_to_one_distance", "'0'");
  expect_refusal("one_to_one_angle: 91", "one_to_one_angle", "'91'");
  expect_refusal("one_to_one_overlap: 1.5", "one_to_one_overlap", "from 0 to 1");
  expect_refusal("bootstrap: -1", "bootstrap", "from 0 to 10000000");
  expect_refusal("bootstrap_block: -2", "bootstrap_block", "'-2'");
  expect_refusal("bootstrap_seed: x", "bootstrap_seed", "'x'");
  expect_refusal("best_lines: 0", "best_lines", "'0'");
  expect_refusal("repeatability_score_thresholds: [high]", "repeatability_score_thresholds",
                 "'high'");
  expect_refusal("frame_step: 0", "frame_step", "'0'");
  expect_refusal("matches_from: id", "matches_from", "topic, ids");
  expect_refusal("frame_step: 1.5", "frame_step", "'1.5'");
  expect_refusal("buffer: 1", "buffer", "from 2 to 1000000");
  expect_refusal("save_period: 0", "save_period", "0.01");
  expect_refusal("idle_timeout: -1", "idle_timeout", "'-1'");
  expect_refusal("drain_timeout: .inf", "drain_timeout", "inf");
  expect_refusal("warn_after: soon", "warn_after", "'soon'");
  expect_refusal("record_parameters: /detector", "record_parameters", "list");
  expect_refusal("input: a.bag", "input", "map");
  expect_refusal("frame_steps: 3", "frame_steps", "did you mean 'frame_step'");
  test::expectError<ConfigError>([] { read("[1, 2]"); }, {"/evaluator", "map"});
}

TEST(EvaluatorOptions, TakeAsManyThresholdsAsTheMetricDoes) {
  std::string numbers = "1";
  for (int i = 2; i <= 16; ++i) numbers += ", " + std::to_string(i);
  const EvaluatorOptions most = read("distance_thresholds: [" + numbers + "]");
  EXPECT_EQ(StreamEvaluator(most.pass).report(false).detection.size(), 32U);
  test::expectError<ConfigError>([&] { read("distance_thresholds: [" + numbers + ", 17]"); },
                                 {"'distance_thresholds'", "at most 16", "got 17"});
}

}  // namespace
}  // namespace evolin::ros_shell
