// Figures as messages, over the wire: every field, and NaN for what is not defined.
#include "metric_messages.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cmath>

namespace evolin::ros_shell {
namespace {

/// What a subscriber in another process gets.
template <typename Message>
Message overTheWire(const Message& message) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  Message result;
  ros::serialization::deserializeMessage(bytes, result);
  return result;
}

MetricHead head() { return {std_msgs::Header(), true, 3, Protocol::kEvolin}; }

TEST(MetricMessages, CarryEveryEntry) {
  std_msgs::Header header;
  header.stamp = ros::Time(1, 2);
  DetectionEntry entry;
  entry.setting = {LineDistance::kOrthogonal, 5};
  entry.counts = {1, 3, 2};
  DetectionEntry scored = entry;
  scored.setting = {LineDistance::kStructural, 7.5};
  scored.average_precision = 0.25;
  const auto message =
      overTheWire(detectionMessage({header, true, 9, Protocol::kPaper}, {entry, scored}, 0.375));
  EXPECT_EQ(message.header.stamp, header.stamp);
  EXPECT_TRUE(message.cumulative);
  EXPECT_EQ(message.frames, 9U);
  EXPECT_EQ(message.protocol, "paper");
  EXPECT_EQ(message.spatial_spread, 0.375);
  ASSERT_EQ(message.entries.size(), 2U);
  EXPECT_EQ(message.entries[0].name, "vectorized");
  EXPECT_EQ(message.entries[0].distance, "orthogonal");
  EXPECT_EQ(message.entries[0].threshold, 5);
  EXPECT_TRUE(std::isnan(message.entries[0].score_threshold));
  EXPECT_DOUBLE_EQ(message.entries[0].precision, 1.0 / 3);
  EXPECT_DOUBLE_EQ(message.entries[0].recall, 0.5);
  EXPECT_DOUBLE_EQ(message.entries[0].f_score, 0.4);
  EXPECT_TRUE(std::isnan(message.entries[0].average_precision));
  EXPECT_EQ(message.entries[1].distance, "structural");
  EXPECT_EQ(message.entries[1].average_precision, 0.25);

  const auto pairs = overTheWire(
      associationMessage({header, false, 1, Protocol::kEvolin}, Classification{1, 2, 4}));
  EXPECT_FALSE(pairs.cumulative);
  EXPECT_EQ(pairs.frames, 1U);
  EXPECT_EQ(pairs.protocol, "evolin");
  ASSERT_EQ(pairs.entries.size(), 1U);
  EXPECT_EQ(pairs.entries[0].name, "association");
  EXPECT_EQ(pairs.entries[0].distance, "");
  EXPECT_TRUE(std::isnan(pairs.entries[0].threshold));
  EXPECT_EQ(pairs.entries[0].precision, 0.5);
  EXPECT_EQ(pairs.entries[0].recall, 0.25);
  EXPECT_TRUE(std::isnan(pairs.entries[0].average_precision));
}

TEST(MetricMessages, CarryEveryCountOfCoverage) {
  CoverageCounts counts;
  counts.seen = 28;
  counts.waiting = 7;
  counts.evaluated = 6;
  counts.unmatched = 5;
  counts.dropped = 4;
  counts.no_ground_truth = 3;
  counts.bad_ground_truth = 2;
  counts.skipped = 1;
  counts.no_depth = 11;
  counts.no_pose = 12;
  counts.heatmap_skipped = 13;
  counts.pose_skipped = 14;
  counts.waiting_depth = 15;
  counts.waiting_pose = 16;
  counts.bad_lines = 17;
  counts.depth_left_out = 18;
  counts.poses_left_out = 19;
  const auto message = overTheWire(coverageMessage(std_msgs::Header(), counts));
  EXPECT_EQ(message.seen, 28U);
  EXPECT_EQ(message.evaluated, 6U);
  EXPECT_EQ(message.unmatched, 5U);
  EXPECT_EQ(message.dropped, 4U);
  EXPECT_EQ(message.no_ground_truth, 3U);
  EXPECT_EQ(message.bad_ground_truth, 2U);
  EXPECT_EQ(message.skipped, 1U);
  EXPECT_EQ(message.no_depth, 11U);
  EXPECT_EQ(message.no_pose, 12U);
  EXPECT_EQ(message.heatmap_skipped, 13U);
  EXPECT_EQ(message.pose_skipped, 14U);
  EXPECT_EQ(message.waiting_depth, 15U);
  EXPECT_EQ(message.waiting_pose, 16U);
  EXPECT_EQ(message.bad_lines, 17U);
  EXPECT_EQ(message.depth_left_out, 18U);
  EXPECT_EQ(message.poses_left_out, 19U);
}

TEST(MetricMessages, HeatmapHasASummaryOnlyOverThresholds) {
  const auto plain = overTheWire(heatmapMessage(head(), {}, {{1, 2, 4}}));
  ASSERT_EQ(plain.entries.size(), 1U);
  EXPECT_EQ(plain.entries[0].name, "heatmap");
  EXPECT_EQ(plain.entries[0].precision, 0.5);
  EXPECT_TRUE(std::isnan(plain.entries[0].score_threshold));
  EXPECT_TRUE(std::isnan(plain.average_precision));
  EXPECT_TRUE(std::isnan(plain.max_f_score));
  const std::vector<Classification> counts = {{1, 1, 4}, {2, 4, 4}};
  const auto scored = overTheWire(heatmapMessage(head(), {0.9, 0.5}, counts));
  ASSERT_EQ(scored.entries.size(), 2U);
  EXPECT_EQ(scored.entries[0].score_threshold, 0.9);
  EXPECT_EQ(scored.average_precision, 0.25 * (1 + 0.5) / 2);
  EXPECT_EQ(scored.max_f_score, 0.5);
}

TEST(MetricMessages, RepeatabilityOfAPairHoldsItsOwnStepAlone) {
  RepeatabilityOptions options;
  options.distance_thresholds = {5};
  options.frame_steps = {1, 10};
  const RepeatabilityMetrics metrics(options);
  RepeatabilityRecord record;
  record.frame_step = 10;
  record.pair = {{10, {4, 8.0}, {1, 1.0}}, {10, {1, 3.0}, {1, 1.0}}};
  const auto message =
      overTheWire(repeatabilityMessage(head(), record, metrics.settings(), {}, false));
  ASSERT_EQ(message.entries.size(), 2U);
  EXPECT_EQ(message.entries[0].step, 10U);
  EXPECT_EQ(message.entries[0].distance, "orthogonal");
  EXPECT_EQ(message.entries[0].threshold, 5);
  EXPECT_EQ(message.entries[0].repeatability, 0.5);
  EXPECT_EQ(message.entries[0].localization_error, 1.5);
  EXPECT_EQ(message.entries[1].distance, "structural");
  EXPECT_EQ(message.entries[1].repeatability, 0.2);
  EXPECT_TRUE(std::isnan(message.one_to_one_by_count));
  EXPECT_TRUE(std::isnan(message.best_localization_error));
}

TEST(MetricMessages, RepeatabilityIsNanBeforeTheFirstPair) {
  const auto message = overTheWire(repeatabilityMessage(head(), PassEvaluation().sums()));
  ASSERT_EQ(message.entries.size(), 6U);
  for (const evolin_ros::RepeatabilityEntry& entry : message.entries) {
    EXPECT_TRUE(std::isnan(entry.repeatability));
    EXPECT_TRUE(std::isnan(entry.localization_error));
  }
  EXPECT_TRUE(std::isnan(message.one_to_one_by_count));
}

TEST(MetricMessages, PoseHoldsMediansAndAreas) {
  PoseErrorMetrics errors;
  errors.addPair({PoseErrors{0.5, 2, 0.01}, 0.2, false});
  errors.addPair({PoseErrors{0.25, 4, 0.03}, 0.005, true});
  errors.addPair({std::nullopt, 0.2, false});
  const auto message = overTheWire(poseMessage(head(), errors, "robust", 5, {1, 3}));
  EXPECT_EQ(message.strategy, "robust");
  EXPECT_EQ(message.step, 5U);
  EXPECT_EQ(message.pairs, 3U);
  EXPECT_EQ(message.failed, 1U);
  EXPECT_EQ(message.ill_conditioned, 1U);
  EXPECT_EQ(message.near_static, 1U);
  EXPECT_EQ(message.rotation_median, 0.5);
  EXPECT_EQ(message.translation_median, 0.03);
  EXPECT_EQ(message.translation_angle_median, 4);
  EXPECT_DOUBLE_EQ(message.success_rate, 2.0 / 3);
  ASSERT_EQ(message.auc.size(), 2U);
  EXPECT_EQ(message.auc[1].threshold, 3);
  EXPECT_GT(message.auc[1].auc, message.auc[1].auc_max);
  const auto none = overTheWire(poseMessage(head(), PoseErrorMetrics(), "evolin", 1, {1}));
  EXPECT_TRUE(std::isnan(none.rotation_median));
  EXPECT_TRUE(std::isnan(none.success_rate));
}

TEST(MetricMessages, TracksSayWhereTheyComeFrom) {
  TrackReport tracks;
  tracks.from_matches = true;
  tracks.frames = 7;
  tracks.tracks = 3;
  tracks.mean_length = 2.5;
  tracks.longest = 4;
  tracks.observations = 6;
  tracks.identity_switches = 2;
  tracks.drifts = 1;
  const auto message = overTheWire(trackMessage(head(), tracks));
  EXPECT_EQ(message.from, "matches");
  EXPECT_EQ(message.frames, 7U);
  EXPECT_EQ(message.tracks, 3U);
  EXPECT_EQ(message.mean_length, 2.5);
  EXPECT_TRUE(std::isnan(message.median_length));
  EXPECT_EQ(message.longest, 4U);
  EXPECT_EQ(message.observations, 6U);
  EXPECT_EQ(message.identity_switches, 2U);
  EXPECT_EQ(message.drifts, 1U);
}

}  // namespace
}  // namespace evolin::ros_shell
