// What becomes of every frame and pair of a pass, in whatever order its parts come.
#include "evolin_ros/evaluation/pass_evaluation.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::annotated;
using test::detected;
using test::expectCounts;
using test::expectEqual;
using test::expectSeenIsTheSum;
using test::handLines;
using test::handTruth;
using test::kSecond;
using test::kStructural10;
using test::kStructural5;
using test::line;
using test::matchSet;
using test::Part;
using test::randomPass;
using test::textOf;
using test::withBuffer;

FrameState stateAt(const Report& report, Stamp stamp) {
  for (const FrameRecord& frame : report.frames) {
    if (frame.stamp == stamp) return frame.state;
  }
  ADD_FAILURE() << "no frame at " << formatStamp(stamp);
  return FrameState::kWaiting;
}

TEST(PassEvaluation, ScoresAFrameOnceBothPartsAreThere) {
  PassEvaluation pass;
  EXPECT_TRUE(pass.addImage(kSecond).frames.empty());
  EXPECT_TRUE(pass.addLines(handLines(kSecond)).frames.empty());
  EXPECT_EQ(pass.coverage().waiting, 1U);
  const EvaluationUpdate update = pass.addGroundTruth(handTruth(kSecond));
  ASSERT_EQ(update.frames.size(), 1U);
  expectCounts(update.frames[0].entries[kStructural5].counts, 1, 3, 2);
  EXPECT_EQ(pass.coverage().evaluated, 1U);
  const Report report = pass.report(true);
  EXPECT_EQ(report.lines_source, "detector");
  EXPECT_EQ(report.ground_truth_source, "ground_truth");
  EXPECT_EQ(report.detection_frames, 1U);
  EXPECT_TRUE(report.scored);
  expectCounts(report.detection[kStructural10].counts, 2, 3, 2);
}

TEST(PassEvaluation, EveryFrameEndsInOneState) {
  PassOptions options = withBuffer(4);
  options.families = {MetricFamily::kDetection, MetricFamily::kAssociation};
  PassEvaluation pass(options);
  pass.addImage(1 * kSecond);                   // its lines never come
  pass.addGroundTruth(handTruth(2 * kSecond));  // has to leave the buffer before its lines come
  pass.addLines(handLines(3 * kSecond));        // its ground truth never comes
  pass.addLines(handLines(4 * kSecond));
  pass.addGroundTruth(annotated(4 * kSecond, {line(9, 9, 9, 9)}));
  LineSet other_size = handLines(5 * kSecond);
  other_size.width = 64;
  pass.addLines(other_size);
  pass.addGroundTruth(handTruth(5 * kSecond));
  pass.addImage(6 * kSecond);
  pass.addLines(handLines(6 * kSecond));
  pass.addGroundTruth(handTruth(6 * kSecond));
  pass.addLines(handLines(2 * kSecond));
  pass.addImage(7 * kSecond);

  const Report now = pass.report(false);
  EXPECT_EQ(stateAt(now, 1 * kSecond), FrameState::kWaiting);
  EXPECT_EQ(stateAt(now, 2 * kSecond), FrameState::kDropped);
  EXPECT_EQ(stateAt(now, 3 * kSecond), FrameState::kWaiting);
  EXPECT_EQ(stateAt(now, 4 * kSecond), FrameState::kBadGroundTruth);
  EXPECT_EQ(stateAt(now, 5 * kSecond), FrameState::kSkipped);
  EXPECT_EQ(stateAt(now, 6 * kSecond), FrameState::kEvaluated);
  EXPECT_EQ(now.coverage.waiting, 3U);
  EXPECT_FALSE(now.complete);

  const Report end = pass.report(true);
  EXPECT_EQ(stateAt(end, 1 * kSecond), FrameState::kUnmatched);
  EXPECT_EQ(stateAt(end, 3 * kSecond), FrameState::kNoGroundTruth);
  EXPECT_EQ(end.coverage.seen, 7U);
  EXPECT_EQ(end.coverage.waiting, 0U);
  EXPECT_EQ(end.coverage.evaluated, 1U);
  EXPECT_EQ(end.coverage.unmatched, 2U);
  EXPECT_EQ(end.coverage.dropped, 1U);
  EXPECT_EQ(end.coverage.no_ground_truth, 1U);
  EXPECT_EQ(end.coverage.bad_ground_truth, 1U);
  EXPECT_EQ(end.coverage.skipped, 1U);
  EXPECT_TRUE(end.complete);
  ASSERT_EQ(end.notes.size(), 2U);
  EXPECT_NE(end.notes[0].find("row 0"), std::string::npos) << end.notes[0];
  EXPECT_NE(end.notes[1].find("64x128"), std::string::npos) << end.notes[1];
}

/// Frames a tenth of a second apart with camera_info `offset` after each, but for frame `lost`.
Report reportWithImages(int frames, Stamp offset, int lost, std::vector<Stamp>* told) {
  constexpr Stamp kPeriod = kSecond / 10;
  PassOptions options;
  options.families = {MetricFamily::kDetection};
  PassEvaluation pass(options);
  const auto take = [told](const EvaluationUpdate& update) {
    if (update.image_offset) told->push_back(*update.image_offset);
  };
  for (int i = 0; i < frames; ++i) {
    const Stamp stamp = kSecond + i * kPeriod;
    take(pass.addImage(stamp + offset));
    if (i == lost) continue;
    take(pass.addLines(handLines(stamp)));
    take(pass.addGroundTruth(handTruth(stamp)));
    expectEqual(pass.coverage(), pass.report(false).coverage);
  }
  EXPECT_FALSE(pass.waiting()) << "what has been passed over does not come";
  return pass.report(true);
}

TEST(PassEvaluation, ImagesWithStampsOfTheirOwnAreNoFrames) {
  constexpr Stamp kMillisecond = kSecond / 1000;
  for (const int frames : {3, 12, 40}) {
    // 45 ms: beyond the tolerance, but no image ever has the stamp of a frame.
    for (const Stamp offset : {Stamp{1}, 5 * kMillisecond, -5 * kMillisecond, 45 * kMillisecond}) {
      SCOPED_TRACE(std::to_string(frames) + " frames, offset " + std::to_string(offset));
      std::vector<Stamp> told;
      const Report report = reportWithImages(frames, offset, frames, &told);
      EXPECT_EQ(report.coverage.seen, static_cast<std::size_t>(frames));
      EXPECT_EQ(report.coverage.evaluated, static_cast<std::size_t>(frames));
      EXPECT_EQ(report.frames.size(), static_cast<std::size_t>(frames));
      ASSERT_EQ(report.notes.size(), 1U);
      EXPECT_NE(report.notes[0].find("camera_info"), std::string::npos) << report.notes[0];
      if (frames > 10) {
        EXPECT_EQ(told, std::vector<Stamp>{std::abs(offset)}) << "once";
      }
    }
  }
}

TEST(PassEvaluation, AnImageWhoseLinesNeverComeIsCounted) {
  for (const int lost : {0, 3, 38}) {
    std::vector<Stamp> told;
    const Report report = reportWithImages(40, 0, lost, &told);
    EXPECT_EQ(report.coverage.seen, 40U);
    EXPECT_EQ(report.coverage.unmatched, 1U);
    EXPECT_EQ(stateAt(report, kSecond + lost * (kSecond / 10)), FrameState::kUnmatched);
    EXPECT_TRUE(told.empty());
    EXPECT_TRUE(report.notes.empty());
  }
}

TEST(PassEvaluation, OfImagesSomeOffTheFramesOnlyThoseAreLeftOut) {
  PassEvaluation pass;
  for (int i = 0; i < 20; ++i) {
    const Stamp stamp = (i + 1) * kSecond;
    pass.addImage(i % 2 == 0 ? stamp : stamp + 200);  // as rounded on the way
    pass.addLines(handLines(stamp));
  }
  EXPECT_EQ(pass.report(true).coverage.seen, 20U);
}

TEST(PassEvaluation, AskingForTheEndDoesNotEndThePass) {
  PassEvaluation pass;
  pass.addLines(handLines(kSecond));
  EXPECT_EQ(pass.report(true).coverage.no_ground_truth, 1U);
  EXPECT_EQ(pass.coverage().waiting, 1U);
  pass.addGroundTruth(handTruth(kSecond));
  EXPECT_EQ(pass.report(true).coverage.evaluated, 1U);
}

TEST(PassEvaluation, PartsInAnyOrderGiveTheSameReport) {
  // Frame steps count from the frames heard of in order of time: repeatability takes no frame after
  // its successors.
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kHeatmap, MetricFamily::kAssociation,
                      MetricFamily::kTracks};
  const std::size_t frames = 20;
  std::size_t evaluated_pairs = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::vector<Part> parts = randomPass(seed, frames);
    PassEvaluation in_order(options);
    for (const Part& part : parts) give(part, &in_order);
    const Report expected = in_order.report(true);
    // Four of the ten kinds of frame cannot be scored: 3, 4, 5 and 9.
    EXPECT_EQ(expected.coverage.evaluated, 12U);
    EXPECT_EQ(expected.coverage.seen, frames);
    evaluated_pairs += expected.pairs.evaluated;

    test::RandomLines random(1000 + seed);
    for (int round = 0; round < 5; ++round) {
      random.shuffle(&parts);
      PassEvaluation shuffled(options);
      for (const Part& part : parts) {
        give(part, &shuffled);
        expectEqual(shuffled.coverage(), shuffled.report(false).coverage);
        expectSeenIsTheSum(shuffled.coverage());
      }
      ASSERT_EQ(textOf(shuffled.report(true)), textOf(expected)) << "seed " << seed;
    }
  }
  EXPECT_GT(evaluated_pairs, 0U);
}

TEST(PassEvaluation, EqualScoresAreRankedInOrderOfTime) {
  // Hit, miss, hit: precision 1, 1/2, 2/3 at recall 1/3, 1/3, 2/3.
  PassEvaluation pass;
  for (const Stamp stamp : {3, 1, 2}) {
    pass.addGroundTruth(annotated(stamp, {line(10, 10, 50, 30)}));
    pass.addLines(
        detected(stamp, {stamp == 2 ? line(10, 100, 40, 110, 0.5) : line(10, 10, 50, 30, 0.5)}));
  }
  EXPECT_DOUBLE_EQ(pass.report(true).detection[kStructural5].average_precision.value(),
                   (0.5 + 2.0 / 3) / 2 / 3);
}

TEST(PassEvaluation, TakesGroundTruthThatComesAfterEverything) {
  PassEvaluation pass;
  for (Stamp stamp = 1; stamp <= 500; ++stamp) {
    pass.addImage(stamp);
    pass.addLines(handLines(stamp));
    if (stamp > 1) pass.addMatches(matchSet(stamp - 1, stamp, "ground_truth", {{0, 0}, {1, 0}}));
  }
  EXPECT_EQ(pass.coverage().waiting, 500U);
  EXPECT_EQ(pass.report(false).pairs.no_ground_truth, 499U);
  std::size_t pairs = 0;
  for (Stamp stamp = 500; stamp >= 1; --stamp) {
    pairs += pass.addGroundTruth(handTruth(stamp)).pairs.size();
  }
  EXPECT_EQ(pairs, 499U);
  const Report report = pass.report(true);
  EXPECT_EQ(report.coverage.evaluated, 500U);
  EXPECT_EQ(report.pairs.evaluated, 499U);
  EXPECT_EQ(report.pairs_expected, 499U);
  EXPECT_EQ(report.pairs.no_ground_truth, 0U);
  expectCounts(report.association, 499, 998, 998);
  expectCounts(report.detection[kStructural5].counts, 500, 1500, 1000);
}

TEST(PassEvaluation, AFullBufferLetsTheOldestGoAndCountsIt) {
  PassEvaluation pass(withBuffer(10));
  for (Stamp stamp = 1; stamp <= 30; ++stamp) pass.addLines(handLines(stamp));
  EXPECT_EQ(pass.coverage().no_ground_truth, 20U);
  EXPECT_EQ(pass.coverage().waiting, 10U);
  for (Stamp stamp = 1; stamp <= 30; ++stamp) {
    pass.addGroundTruth(handTruth(stamp));
    expectEqual(pass.coverage(), pass.report(false).coverage);
    expectSeenIsTheSum(pass.coverage());
  }
  EXPECT_EQ(pass.coverage().dropped, 20U);
  EXPECT_EQ(pass.coverage().evaluated, 10U);
  EXPECT_EQ(pass.coverage().seen, 30U);
}

TEST(PassEvaluation, WaitsForLinesAndForTheNewestMatches) {
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kAssociation};
  PassEvaluation pass(options);
  EXPECT_FALSE(pass.waiting());
  pass.addImage(1);
  EXPECT_TRUE(pass.waiting());
  pass.addLines(handLines(1));
  EXPECT_FALSE(pass.waiting()) << "ground truth may never come";
  pass.addGroundTruth(handTruth(2));
  EXPECT_TRUE(pass.waiting());
  pass.addLines(handLines(2));
  EXPECT_FALSE(pass.waiting()) << "nobody sends matches";
  pass.addMatches(matchSet(1, 2, "detector", {}));
  EXPECT_FALSE(pass.waiting());
  pass.addLines(handLines(3));
  EXPECT_TRUE(pass.waiting());
  pass.addMatches(matchSet(2, 3, "detector", {}));
  EXPECT_FALSE(pass.waiting());
  pass.addGroundTruth(handTruth(5));
  EXPECT_TRUE(pass.waiting());
  pass.addLines(handLines(6));
  pass.addMatches(matchSet(3, 6, "detector", {}));
  EXPECT_FALSE(pass.waiting()) << "left out by a front-end that sends in order";
  pass.addLines(handLines(4));
  EXPECT_TRUE(pass.waiting()) << "this one does not";
}

TEST(PassEvaluation, TimesThatAreNoneAreNotMeasured) {
  PassEvaluation pass;
  Stamp stamp = 0;
  for (const double time : {0.2, 0.4, 0.0, -1.0, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    LineSet lines = handLines(++stamp);
    lines.processing_time = time;
    pass.addLines(lines);
    MatchSet matches = matchSet(stamp - 1, stamp, "ground_truth", {});
    matches.processing_time = time;
    pass.addMatches(matches);
  }
  const Report report = pass.report(true);
  for (const TimingSummary& timing : {report.detector_timing, report.associator_timing}) {
    EXPECT_EQ(timing.frames, 2U);
    EXPECT_DOUBLE_EQ(timing.mean, 0.3);
    EXPECT_DOUBLE_EQ(timing.rate, 1 / 0.3);
  }
}

TEST(PassEvaluation, KeepsAHundredNotesAndSaysHowManyMore) {
  PassEvaluation pass;
  std::size_t told = 0;
  for (Stamp stamp = 1; stamp <= 130; ++stamp) {
    pass.addLines(handLines(stamp));
    told += pass.addGroundTruth(annotated(stamp, {line(9, 9, 9, 9)})).notes.size();
  }
  EXPECT_EQ(told, 130U);
  const Report report = pass.report(true);
  ASSERT_EQ(report.notes.size(), 101U);
  EXPECT_EQ(report.notes.back(), "and 30 more of these");
  EXPECT_EQ(report.coverage.bad_ground_truth, 130U);
}

TEST(PassEvaluation, HeatmapOfLinesWithoutScoresIsThatWithoutThresholds) {
  PassOptions plain;
  plain.families = {MetricFamily::kHeatmap};
  PassOptions by_score = plain;
  by_score.evaluation.heatmap.score_thresholds = {0.5, 0.1};
  std::vector<Report> reports;
  for (const PassOptions& options : {plain, by_score}) {
    PassEvaluation pass(options);
    const TaskRunner runner({options.evaluation.heatmap, options.motion.pose_method});
    for (const Stamp stamp : {1, 2, 3}) {
      LineSet lines = handLines(stamp);
      lines.scored = false;
      for (LineSegment& line : lines.lines) line.score = kNoScore;
      if (stamp == 2) lines.lines.clear();
      pass.addGroundTruth(handTruth(stamp));
      for (const EvaluationTask& task : pass.addLines(lines).tasks) {
        pass.addResult(runner.run(task));
      }
    }
    reports.push_back(pass.report(true));
  }
  const Classification& expected = reports[0].heatmap.counts.at(0);
  const UnscoredHeatmap& unscored = reports[1].heatmap.unscored;
  EXPECT_EQ(unscored.frames, 2U);
  EXPECT_EQ(unscored.empty_frames, 1U);
  EXPECT_GT(expected.true_positives, 0U);
  EXPECT_EQ(unscored.counts.true_positives, expected.true_positives);
  EXPECT_EQ(unscored.counts.predicted, expected.predicted);
  EXPECT_EQ(unscored.counts.ground_truth, expected.ground_truth);
  EXPECT_EQ(reports[1].coverage.heatmap_skipped, 0U);
  EXPECT_NE(whyNoHeatmap(reports[1]).find("no scores"), std::string::npos);
  EXPECT_NE(toJson(reports[1]).find("\"unscored\""), std::string::npos);
  EXPECT_NE(toMarkdown(reports[1]).find("lines without scores"), std::string::npos);
  EXPECT_EQ(whyNoHeatmap(reports[0]), "");
}

TEST(PassEvaluation, IsNotCompleteWhileTasksAreUnderWay) {
  PassEvaluation pass;
  pass.addGroundTruth(handTruth(1));
  const EvaluationUpdate update = pass.addLines(handLines(1));
  ASSERT_EQ(update.tasks.size(), 1U);
  EXPECT_FALSE(pass.report(true).complete);
  pass.skipPending();
  EXPECT_TRUE(pass.report(true).complete);
  EXPECT_EQ(pass.report(true).coverage.heatmap_skipped, 1U);
  EXPECT_EQ(pass.report(true).notes.size(), 1U);
}

}  // namespace
}  // namespace evolin
