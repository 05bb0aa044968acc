// Depth, poses and matches join the lines of their frames, however they come; what lacks one is
// counted.
#include "evolin_ros/evaluation/motion_evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/evaluation/sample_frames.h"
#include "test/evaluation/wall_walk.h"

namespace evolin {
namespace {

using test::annotated;
using test::detected;
using test::kMillisecond;
using test::kPeriod;
using test::line;
using test::linesAt;
using test::matchSet;
using test::poseAt;
using test::same;
using test::shortSteps;
using test::stampOf;
using test::wall;
using test::wallDepth;
using test::wallWalkCamera;

/// Everything that updates brought.
struct Collected {
  std::vector<RepeatabilityRecord> repeatability;
  std::vector<PoseTask> tasks;
  std::vector<std::string> notes;

  void take(MotionUpdate update) {
    repeatability.insert(repeatability.end(), update.repeatability.begin(),
                         update.repeatability.end());
    tasks.insert(tasks.end(), update.pose_tasks.begin(), update.pose_tasks.end());
    notes.insert(notes.end(), update.notes.begin(), update.notes.end());
  }
};

void addFrame(MotionEvaluation* motion, int frame, Collected* collected) {
  collected->take(motion->addDepth(stampOf(frame), wall()));
  collected->take(motion->addPose(poseAt(frame)));
  collected->take(motion->addLines(detected(stampOf(frame), linesAt(frame))));
}

TEST(MotionEvaluation, FindsTheLinesOfAWallAgain) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 4; ++frame) addFrame(&motion, frame, &collected);
  ASSERT_EQ(collected.repeatability.size(), 3U) << "scored at once: depth and pose are exact";
  EXPECT_EQ(collected.repeatability[2].first_stamp, stampOf(2));
  EXPECT_EQ(collected.repeatability[2].stamp, stampOf(3));
  for (const RepeatabilityRecord& record : collected.repeatability) {
    for (const PairRepeatability& pair : record.pair) {
      EXPECT_EQ(pair.repeatability(), 1);
      EXPECT_NEAR(pair.localizationError(Protocol::kEvolin), 0, 1e-9);
    }
    EXPECT_EQ(record.one_to_one_by_count, 1);
    EXPECT_EQ(record.best.used, 6U);
  }
  EXPECT_EQ(motion.counts().frames, 4U);
  EXPECT_EQ(motion.counts().no_depth + motion.counts().no_pose + motion.counts().late, 0U);
}

TEST(MotionEvaluation, ScoreThresholdsComeBesidesAllLines) {
  MotionOptions options = shortSteps();
  options.repeatability_score_thresholds = {0.75, 0.95};
  MotionEvaluation motion(options);
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 3; ++frame) addFrame(&motion, frame, &collected);
  ASSERT_TRUE(motion.repeatabilityByScore().has_value());
  const RepeatabilityMetrics& by_score = *motion.repeatabilityByScore();
  const std::size_t settings = motion.repeatability().settings().size();
  ASSERT_EQ(by_score.settings().size(), 2 * settings);
  ASSERT_EQ(collected.repeatability.size(), 2U);
  for (const RepeatabilityRecord& record : collected.repeatability) {
    ASSERT_EQ(record.pair.size(), settings);
    ASSERT_EQ(record.by_score.size(), 2 * settings);
    EXPECT_EQ(record.pair[0].lines, 6U);
    EXPECT_EQ(record.by_score[0].lines, 4U);
    EXPECT_EQ(record.by_score[settings].lines, 0U);
  }
  EXPECT_EQ(by_score.figures(0)->repeatability, 1);
  EXPECT_EQ(by_score.figures(settings)->repeatability, 0);
  EXPECT_EQ(motion.counts().unscored_pairs, 0U);
}

TEST(MotionEvaluation, LinesWithoutScoresHaveTheirRepeatabilityWithoutThresholds) {
  MotionOptions options = shortSteps();
  options.repeatability_score_thresholds = {0.75};
  MotionEvaluation motion(options);
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 3; ++frame) {
    LineSegments lines = linesAt(frame);
    lines[1].score = kNoScore;
    collected.take(motion.addDepth(stampOf(frame), wall()));
    collected.take(motion.addPose(poseAt(frame)));
    collected.take(motion.addLines(detected(stampOf(frame), lines)));
  }
  EXPECT_TRUE(collected.notes.empty());
  EXPECT_EQ(motion.repeatability().pairs(1), 2U);
  EXPECT_EQ(motion.repeatability().figures(0)->repeatability, 1);
  EXPECT_EQ(motion.repeatabilityByScore()->pairs(1), 0U);
  EXPECT_EQ(motion.counts().unscored_pairs, 2U);
}

TEST(MotionEvaluation, CountsStepsOverFramesWithoutLines) {
  MotionOptions options;
  options.repeatabilities.frame_steps = {2};
  MotionEvaluation motion(options);
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 6; ++frame) {
    collected.take(motion.addImage(stampOf(frame)));
    if (frame != 1) addFrame(&motion, frame, &collected);
  }
  collected.take(motion.finish());
  // 0-2, 2-4, 3-5; frame 1 has no lines, so neither 1-3.
  ASSERT_EQ(collected.repeatability.size(), 3U);
  for (const RepeatabilityRecord& record : collected.repeatability) {
    EXPECT_EQ(record.stamp - record.first_stamp, 2 * kPeriod);
  }
}

TEST(MotionEvaluation, WaitsForDepthAndPosesOfAnyOrder) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  for (int frame = 0; frame < 3; ++frame) {
    collected.take(motion.addLines(detected(stampOf(frame), linesAt(frame))));
  }
  for (int frame = 0; frame < 3; ++frame) collected.take(motion.addPose(poseAt(frame)));
  for (int frame = 0; frame < 3; ++frame) collected.take(motion.addDepth(stampOf(frame), wall()));
  EXPECT_TRUE(collected.repeatability.empty()) << "no camera yet";
  collected.take(motion.setCamera(wallWalkCamera()));
  EXPECT_EQ(collected.repeatability.size(), 2U);
}

TEST(MotionEvaluation, TakesTheNearestDepthWithinTheTolerance) {
  for (const Stamp offset : {-21 * kMillisecond, -20 * kMillisecond, -kMillisecond, kMillisecond,
                             20 * kMillisecond, 21 * kMillisecond}) {
    MotionEvaluation motion(shortSteps());
    Collected collected;
    collected.take(motion.setCamera(wallWalkCamera()));
    for (int frame = 0; frame < 3; ++frame) {
      collected.take(motion.addPose(poseAt(frame)));
      collected.take(motion.addLines(detected(stampOf(frame), linesAt(frame))));
      collected.take(motion.addDepth(stampOf(frame) + offset, wall()));
    }
    collected.take(motion.finish());
    const bool near = std::abs(offset) <= 20 * kMillisecond;
    EXPECT_EQ(collected.repeatability.size(), near ? 2U : 0U) << offset;
    EXPECT_EQ(motion.counts().no_depth, near ? 0U : 3U) << offset;
    EXPECT_EQ(motion.nearestDepthMiss().has_value(), !near);
    if (!near) {
      EXPECT_EQ(*motion.nearestDepthMiss(), 21 * kMillisecond);
    }
  }
}

TEST(MotionEvaluation, CountsWhatIsMissing) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 6; ++frame) {
    if (frame != 1) collected.take(motion.addDepth(stampOf(frame), wall()));
    // Without a neighbour within 0.1 s there is no interpolation.
    if (frame < 3) collected.take(motion.addPose(poseAt(frame)));
    collected.take(motion.addLines(detected(stampOf(frame), linesAt(frame))));
  }
  EXPECT_EQ(motion.counts().no_depth, 1U) << "later depth is there";
  EXPECT_EQ(motion.waiting().depth, 0U);
  EXPECT_EQ(motion.waiting().pose, 3U);
  collected.take(motion.finish());
  EXPECT_EQ(motion.waiting().pose, 0U);
  EXPECT_EQ(motion.counts().frames, 2U);
  EXPECT_EQ(motion.counts().no_depth, 1U);
  EXPECT_EQ(motion.counts().no_pose, 3U);
  EXPECT_TRUE(collected.repeatability.empty()) << "0 and 2 are two steps apart";
}

TEST(MotionEvaluation, AFullBufferGoesOnAndCounts) {
  MotionOptions options = shortSteps();
  options.buffer = 5;
  MotionEvaluation motion(options);
  for (int frame = 0; frame < 20; ++frame) {
    motion.addLines(detected(stampOf(frame), linesAt(frame)));
    motion.addMatches(matchSet(stampOf(frame - 1), stampOf(frame), "detector", same(3)));
  }
  EXPECT_EQ(motion.counts().no_pose, 15U);
  motion.finish();
  EXPECT_EQ(motion.counts().no_pose, 20U);
  EXPECT_EQ(motion.counts().pairs_left_buffer, 16U);
  EXPECT_EQ(motion.counts().pairs_no_pose, 4U);
}

TEST(MotionEvaluation, GivesMatchedPairsOutAsTasks) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 2; ++frame) {
    collected.take(motion.addGroundTruth(annotated(stampOf(frame), linesAt(frame))));
    addFrame(&motion, frame, &collected);
  }
  // Of detected lines, and of annotated ones of which the first is left out.
  collected.take(motion.addMatches(matchSet(stampOf(0), stampOf(1), "detector", same(3))));
  ASSERT_EQ(collected.tasks.size(), 1U);
  const PoseTask& task = collected.tasks[0];
  EXPECT_EQ(task.first_stamp, stampOf(0));
  EXPECT_EQ(task.stamp, stampOf(1));
  EXPECT_EQ(task.matched, 3U);
  ASSERT_EQ(task.matches.size(), 3U);
  EXPECT_EQ(task.matches[1].first.pixel1, Eigen::Vector2d(50, 60));
  EXPECT_EQ(task.matches[1].second.pixel1, Eigen::Vector2d(49, 60));
  EXPECT_NEAR(task.truth.translation.x(), -test::kMetresPerPixel, 1e-12);
  collected.take(motion.addMatches(matchSet(stampOf(0), stampOf(1), "ground_truth", {{1, 1}})));
  ASSERT_EQ(collected.tasks.size(), 2U);
  EXPECT_EQ(collected.tasks[1].matches.size(), 1U);
  EXPECT_EQ(motion.counts().pose_pairs, 2U);

  collected.take(motion.addMatches(matchSet(stampOf(0), stampOf(1), "detector", {{3, 0}})));
  EXPECT_EQ(motion.counts().pairs_skipped, 1U);
  ASSERT_EQ(collected.notes.size(), 1U);
  EXPECT_NE(collected.notes[0].find("line 3"), std::string::npos) << collected.notes[0];
}

TEST(MotionEvaluation, MatchesWaitForTheirFrames) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  collected.take(motion.addMatches(matchSet(stampOf(0), stampOf(1), "detector", same(3))));
  collected.take(motion.addMatches(matchSet(stampOf(1), stampOf(2), "detector", same(3))));
  for (int frame = 0; frame < 2; ++frame) addFrame(&motion, frame, &collected);
  EXPECT_EQ(collected.tasks.size(), 1U);
  collected.take(motion.finish());
  EXPECT_EQ(motion.counts().pairs_no_lines, 1U) << "frame 2 never came";
  EXPECT_EQ(motion.counts().pairs_no_pose, 0U);
}

TEST(MotionEvaluation, LinesThatAreNotFiniteHaveAReasonOfTheirOwn) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (int frame = 0; frame < 3; ++frame) {
    collected.take(motion.addDepth(stampOf(frame), wall()));
    collected.take(motion.addPose(poseAt(frame)));
    LineSet lines = detected(stampOf(frame), linesAt(frame));
    if (frame == 1) lines.lines[2].y1 = std::nan("");
    collected.take(motion.addLines(lines));
    if (frame > 0) {
      collected.take(
          motion.addMatches(matchSet(stampOf(frame - 1), stampOf(frame), "detector", same(2))));
    }
  }
  EXPECT_EQ(motion.counts().bad_lines, 1U);
  EXPECT_EQ(motion.counts().no_depth + motion.counts().no_pose, 0U);
  EXPECT_EQ(motion.counts().frames, 2U);
  EXPECT_EQ(motion.counts().pairs_bad_lines, 2U);
  EXPECT_EQ(motion.counts().pairs_no_depth, 0U);
  ASSERT_EQ(collected.notes.size(), 1U);
  EXPECT_NE(collected.notes[0].find("row 2"), std::string::npos) << collected.notes[0];
}

TEST(MotionEvaluation, ACopyThatFinishesLeavesTheOriginalWaiting) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  addFrame(&motion, 0, &collected);
  collected.take(motion.addLines(detected(stampOf(1), linesAt(1))));
  MotionEvaluation copy = motion;
  copy.finish();
  EXPECT_EQ(copy.counts().no_pose, 1U);
  EXPECT_EQ(motion.waiting().pose, 1U);
  collected.take(motion.addPose(poseAt(1)));
  EXPECT_EQ(motion.waiting().pose, 0U);
  EXPECT_EQ(motion.waiting().depth, 1U);
  collected.take(motion.addDepth(stampOf(1), wall()));
  EXPECT_EQ(motion.waiting().depth, 0U);
  EXPECT_EQ(motion.counts().frames, 2U);
  EXPECT_EQ(collected.repeatability.size(), 1U);
}

TEST(MotionEvaluation, NamesACameraThatChanges) {
  MotionEvaluation motion(shortSteps());
  EXPECT_TRUE(motion.setCamera(wallWalkCamera()).notes.empty());
  EXPECT_TRUE(motion.setCamera(wallWalkCamera()).notes.empty());
  Camera other = wallWalkCamera();
  other.fx += 1;
  EXPECT_EQ(motion.setCamera(other).notes.size(), 1U);
  EXPECT_TRUE(motion.setCamera(other).notes.empty()) << "said once";
}

TEST(MotionEvaluation, RefusesDepthOfAnotherSize) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  collected.take(motion.addPose(poseAt(0)));
  collected.take(motion.addLines(detected(stampOf(0), linesAt(0))));
  const cv::Mat half(test::kWallSide / 2, test::kWallSide / 2, CV_32FC1, cv::Scalar(2));
  collected.take(motion.addDepth(stampOf(0), DepthMap(half)));
  EXPECT_EQ(motion.counts().no_depth, 1U);
  ASSERT_EQ(collected.notes.size(), 1U);
  EXPECT_NE(collected.notes[0].find("128x128"), std::string::npos) << collected.notes[0];
  EXPECT_NE(collected.notes[0].find("64x64"), std::string::npos) << collected.notes[0];
}

TEST(MotionEvaluation, NamesDistortionAndDepthThatHasLeft) {
  Camera distorted = wallWalkCamera();
  distorted.distortion = {0.1, 0, 0, 0, 0};
  MotionOptions options = shortSteps();
  options.depth_buffer = 2;
  MotionEvaluation motion(options);
  Collected collected;
  collected.take(motion.setCamera(distorted));
  ASSERT_EQ(collected.notes.size(), 1U);
  EXPECT_NE(collected.notes[0].find("distortion"), std::string::npos);
  for (int frame = 0; frame < 6; ++frame) {
    collected.take(motion.addDepth(stampOf(frame), wall()));
    collected.take(motion.addPose(poseAt(frame)));
  }
  for (int frame = 0; frame < 6; ++frame) {
    collected.take(motion.addLines(detected(stampOf(frame), linesAt(frame))));
  }
  EXPECT_EQ(motion.counts().no_depth, 4U);
  ASSERT_EQ(collected.notes.size(), 2U) << "said once";
  EXPECT_NE(collected.notes[1].find("depth_buffer"), std::string::npos) << collected.notes[1];
}

/// Depth images that somebody holds besides the test.
std::size_t countHeld(const std::vector<cv::Mat>& images) {
  return static_cast<std::size_t>(std::count_if(
      images.begin(), images.end(), [](const cv::Mat& image) { return image.u->refcount > 1; }));
}

TEST(MotionEvaluation, DepthStaysForLateGroundTruthAndLeavesWhereNothingLacks) {
  for (const bool late : {false, true}) {
    SCOPED_TRACE(late ? "ground truth comes last" : "ground truth comes with its frame");
    MotionEvaluation motion(shortSteps());
    Collected collected;
    collected.take(motion.setCamera(wallWalkCamera()));
    std::vector<cv::Mat> depths;
    constexpr int kFrames = 25;
    for (int frame = 0; frame < kFrames; ++frame) {
      depths.push_back(wallDepth().clone());
      collected.take(motion.addDepth(stampOf(frame), DepthMap(depths.back())));
      collected.take(motion.addPose(poseAt(frame)));
      collected.take(motion.addLines(detected(stampOf(frame), linesAt(frame))));
      if (!late) collected.take(motion.addGroundTruth(annotated(stampOf(frame), linesAt(frame))));
    }
    EXPECT_EQ(countHeld(depths), late ? kFrames : 10U)
        << "8 before the settled one, and the newest";
    for (const int frame : {0, 1}) {
      if (late) collected.take(motion.addGroundTruth(annotated(stampOf(frame), linesAt(frame))));
    }
    collected.take(motion.addMatches(matchSet(stampOf(0), stampOf(1), "ground_truth", same(3))));
    EXPECT_EQ(collected.tasks.size(), 1U);
    EXPECT_TRUE(collected.notes.empty());
  }
}

TEST(MotionEvaluation, LateLinesAreCountedAndNotScored) {
  MotionEvaluation motion(shortSteps());
  Collected collected;
  collected.take(motion.setCamera(wallWalkCamera()));
  for (const int frame : {0, 2, 3}) addFrame(&motion, frame, &collected);
  EXPECT_EQ(collected.repeatability.size(), 2U) << "frame 1 was never heard of";
  addFrame(&motion, 1, &collected);
  EXPECT_EQ(motion.counts().late, 1U);
  EXPECT_EQ(collected.repeatability.size(), 2U);
}

}  // namespace
}  // namespace evolin
