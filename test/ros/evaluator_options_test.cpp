// The evaluator's parameters: defaults, ranges, and errors that name the parameter.
#include "evaluator_options.h"

#include <gtest/gtest.h>

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
