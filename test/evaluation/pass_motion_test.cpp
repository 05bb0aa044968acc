// A whole pass with depth, poses and matches: what becomes of them in its report.
#include <gtest/gtest.h>

#include <vector>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/evaluation/sample_frames.h"
#include "test/evaluation/wall_walk.h"

namespace evolin {
namespace {

using test::annotated;
using test::detected;
using test::kMillisecond;
using test::kPeriod;
using test::linesAt;
using test::matchSet;
using test::poseAt;
using test::same;
using test::shortSteps;
using test::stampOf;
using test::wall;
using test::wallWalkCamera;

TEST(PassEvaluation, FrameStepsDoNotCountImagesWithStampsOfTheirOwn) {
  for (const Stamp offset : {kMillisecond, 45 * kMillisecond}) {
    PassOptions options;
    options.motion = shortSteps();
    options.motion.repeatabilities.frame_steps = {2};
    options.families = {MetricFamily::kRepeatability};
    PassEvaluation pass(options);
    pass.setCamera(wallWalkCamera());
    for (int frame = 0; frame < 20; ++frame) {
      pass.addImage(stampOf(frame) + offset);
      pass.addDepth(stampOf(frame), wall());
      pass.addPose(poseAt(frame));
      pass.addLines(detected(stampOf(frame), linesAt(frame)));
    }
    const Report report = pass.report(true);
    ASSERT_EQ(report.repeatability.records.size(), 18U) << offset;
    for (const RepeatabilityRecord& record : report.repeatability.records) {
      EXPECT_EQ(record.stamp - record.first_stamp, 2 * kPeriod);
    }
  }
}

TEST(PassEvaluation, APoseEstimateSaysOverHowManyImagesItReaches) {
  PassOptions options;
  options.frame_step = 5;  // what somebody said
  options.families = {MetricFamily::kPose};
  for (const bool own_stamps : {true, false}) {
    PassEvaluation pass(options);
    std::vector<int> steps;
    const auto take = [&](EvaluationUpdate update) {
      test::runTasks({}, &pass, &update);
      for (const PoseRecord& record : update.poses) steps.push_back(record.frame_step);
    };
    take(pass.setCamera(wallWalkCamera()));
    for (int frame = 0; frame < 5; ++frame) {
      take(pass.addImage(stampOf(frame) + (own_stamps ? 0 : 45 * kMillisecond)));
      take(pass.addDepth(stampOf(frame), wall()));
      take(pass.addPose(poseAt(frame)));
      take(pass.addLines(detected(stampOf(frame), linesAt(frame))));
      if (frame >= 2) {
        take(pass.addMatches(matchSet(stampOf(frame - 2), stampOf(frame), "detector", same(3))));
      }
    }
    EXPECT_EQ(steps, (std::vector<int>{2, 2, 2}));
    EXPECT_EQ(pass.poseStep(), 2);
    EXPECT_EQ(pass.report(true).pose.frame_step, 2);
    take(pass.addMatches(matchSet(stampOf(3), stampOf(4), "detector", same(3))));
    EXPECT_EQ(pass.poseStep(), 0) << "not the same for all";
    EXPECT_EQ(pass.report(true).pose.frame_step, 0);
    EXPECT_EQ(pass.report(true).pose.records.back().frame_step, 1);
  }
}

TEST(PassEvaluation, AllFamiliesComeTogetherInTheReport) {
  PassOptions options;
  options.motion.repeatabilities.frame_steps = {1};
  PassEvaluation pass(options);
  const auto take = [&](EvaluationUpdate update) { test::runTasks({}, &pass, &update); };
  take(pass.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 5; ++frame) {
    take(pass.addDepth(stampOf(frame), wall()));
    take(pass.addPose(poseAt(frame)));
    take(pass.addGroundTruth(annotated(stampOf(frame), linesAt(frame))));
    take(pass.addLines(detected(stampOf(frame), linesAt(frame))));
    if (frame > 0) {
      take(pass.addMatches(matchSet(stampOf(frame - 1), stampOf(frame), "detector", same(3))));
    }
  }
  EXPECT_FALSE(pass.waiting());
  const Report report = pass.report(true);
  EXPECT_EQ(report.heatmap.frames, 5U);
  EXPECT_EQ(report.heatmap.counts.at(0).fScore(), 1);
  EXPECT_EQ(report.repeatability.rows.at(0).pairs, 4U);
  EXPECT_EQ(report.repeatability.rows.at(0).figures->repeatability, 1);
  EXPECT_EQ(report.detected_pairs.evaluated, 4U);
  EXPECT_EQ(report.detected_association.fScore(), 1);
  EXPECT_EQ(report.pose.errors.pairs(), 4U);
  EXPECT_EQ(report.pose.records.size(), 4U);
  EXPECT_EQ(report.tracks.tracks, 3U);
  EXPECT_EQ(report.tracks.mean_length, 5);
  EXPECT_EQ(report.tracks.identity_switches, 0U);
  EXPECT_EQ(report.coverage.no_depth + report.coverage.no_pose, 0U);
  EXPECT_NE(motionsToTum(report, false).find("0.200000 0.015625 0 0 0 0 0 1"), std::string::npos)
      << motionsToTum(report, false);
}

TEST(PassEvaluation, SkippedTasksAreCounted) {
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kHeatmap};
  PassEvaluation pass(options);
  pass.addGroundTruth(test::handTruth(1));
  const EvaluationUpdate update = pass.addLines(test::handLines(1));
  ASSERT_EQ(update.tasks.size(), 1U);
  EXPECT_TRUE(pass.waiting());
  pass.skip(update.tasks[0]);
  EXPECT_FALSE(pass.waiting());
  const Report report = pass.report(true);
  EXPECT_EQ(report.coverage.heatmap_skipped, 1U);
  EXPECT_EQ(report.coverage.evaluated, 1U);
  EXPECT_EQ(whyNoHeatmap(report), "not evaluated: all frames were skipped");
}

}  // namespace
}  // namespace evolin
