// One frame's and a sequence's figures against those computed by hand, and what is refused.
#include "evolin_ros/evaluation/sequence_evaluator.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/evaluation/sample_frames.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::annotated;
using test::detected;
using test::expectCounts;
using test::expectError;
using test::handLines;
using test::handTruth;
using test::kOrthogonal5;
using test::kSecond;
using test::kStructural10;
using test::kStructural5;
using test::line;
using test::matchSet;

TEST(SequenceEvaluator, ScoresAFrameAsByHand) {
  SequenceEvaluator evaluator;
  LineSet lines = handLines(7 * kSecond);
  lines.processing_time = 0.25;
  const FrameRecord record = evaluator.addFrame(0, lines, handTruth(7 * kSecond));
  EXPECT_EQ(record.stamp, 7 * kSecond);
  EXPECT_EQ(record.state, FrameState::kEvaluated);
  EXPECT_EQ(record.lines, 3U);
  EXPECT_EQ(record.ground_truth, 2U);
  EXPECT_EQ(record.processing_time, 0.25);
  ASSERT_EQ(record.entries.size(), 6U);
  expectCounts(record.entries[kOrthogonal5].counts, 2, 3, 2);
  expectCounts(record.entries[kStructural5].counts, 1, 3, 2);
  expectCounts(record.entries[kStructural10].counts, 2, 3, 2);
  const Classification& counts = record.entries[kStructural5].counts;
  EXPECT_DOUBLE_EQ(counts.precision(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(counts.recall(), 0.5);
  EXPECT_DOUBLE_EQ(counts.fScore(), 0.4);
  // Recall never moves from its first 1/2, so the area is none; with two hits it is that between
  // recall 1/2 and 1 at precision 1.
  EXPECT_DOUBLE_EQ(record.entries[kStructural5].average_precision.value(), 0);
  EXPECT_DOUBLE_EQ(record.entries[kStructural10].average_precision.value(), 0.5);
}

TEST(SequenceEvaluator, SumsCountsOverFrames) {
  SequenceEvaluator evaluator;
  evaluator.addFrame(0, handLines(kSecond), handTruth(kSecond));
  evaluator.addFrame(1, detected(2 * kSecond, {}), handTruth(2 * kSecond));
  evaluator.addFrame(2, handLines(3 * kSecond), annotated(3 * kSecond, {}));
  const std::vector<DetectionEntry> entries = evaluator.detectionEntries();
  expectCounts(entries[kOrthogonal5].counts, 2, 6, 4);
  expectCounts(entries[kStructural5].counts, 1, 6, 4);
  EXPECT_EQ(evaluator.detection().frames(), 3U);
}

TEST(SequenceEvaluator, FramesMayBeAddedInAnyOrder) {
  SequenceEvaluator rising;
  SequenceEvaluator falling;
  const auto add = [](SequenceEvaluator* evaluator, std::uint32_t number) {
    // All scores are equal: only the frames' numbers order them. The middle frame is a miss.
    const LineSegment found = number == 1 ? line(10, 100, 40, 110, 0.5) : line(10, 10, 50, 30, 0.5);
    evaluator->addFrame(number, detected(number * kSecond, {found}),
                        annotated(number * kSecond, {line(10, 10, 50, 30)}));
  };
  for (std::uint32_t number : {0U, 1U, 2U}) add(&rising, number);
  for (std::uint32_t number : {2U, 1U, 0U}) add(&falling, number);
  // Points (1/3, 1), (1/3, 1/2), (2/3, 2/3).
  const double area = (0.5 + 2.0 / 3) / 2 / 3;
  EXPECT_DOUBLE_EQ(rising.detectionEntries()[kStructural5].average_precision.value(), area);
  EXPECT_DOUBLE_EQ(falling.detectionEntries()[kStructural5].average_precision.value(), area);
}

TEST(SequenceEvaluator, RoomForALateFrameKeepsEverythingElse) {
  SequenceEvaluator evaluator;
  evaluator.addFrame(0, handLines(kSecond), handTruth(kSecond));
  evaluator.addFrame(1, handLines(3 * kSecond), handTruth(3 * kSecond));
  evaluator.makeRoom(1);
  evaluator.addFrame(1, handLines(2 * kSecond), handTruth(2 * kSecond));
  SequenceEvaluator reference;
  for (std::uint32_t number : {0U, 1U, 2U}) {
    reference.addFrame(number, handLines(number * kSecond), handTruth(number * kSecond));
  }
  for (std::size_t setting = 0; setting < 6; ++setting) {
    expectCounts(evaluator.detectionEntries()[setting].counts,
                 reference.detectionEntries()[setting].counts.true_positives, 9, 6);
    EXPECT_EQ(evaluator.detectionEntries()[setting].average_precision,
              reference.detectionEntries()[setting].average_precision);
  }
}

TEST(SequenceEvaluator, RefusesWhatItCannotScoreAndAddsNothing) {
  SequenceEvaluator evaluator;
  LineSet no_size = handLines(kSecond);
  no_size.height = 0;
  expectError([&] { evaluator.addFrame(0, no_size, handTruth(kSecond)); },
              {"1.000000", "128x0", "expected the size of the image"});
  LineSet larger = handTruth(kSecond);
  larger.width = 640;
  expectError([&] { evaluator.addFrame(0, handLines(kSecond), larger); },
              {"frame 1.000000", "128x128", "640x128"});
  expectError<GroundTruthError>(
      [&] { evaluator.addFrame(0, handLines(kSecond), annotated(kSecond, {line(5, 5, 5, 5)})); },
      {"frame 1.000000", "row 0", "no length"});
  LineSet infinite = handLines(kSecond);
  infinite.lines[2].x1 = std::numeric_limits<double>::infinity();
  expectError([&] { evaluator.addFrame(0, infinite, handTruth(kSecond)); },
              {"1.000000", "row 2", "not finite"});
  EXPECT_EQ(evaluator.detection().frames(), 0U);
  expectCounts(evaluator.detectionEntries()[kStructural5].counts, 0, 0, 0);
}

TEST(SequenceEvaluator, NamesTheFrameThatHasScoresUnlikeTheOthers) {
  SequenceEvaluator evaluator;
  evaluator.addFrame(0, handLines(kSecond), handTruth(kSecond));
  const LineSet unscored = detected(2 * kSecond, {line(10, 10, 50, 30)});
  expectError([&] { evaluator.addFrame(1, unscored, handTruth(2 * kSecond)); },
              {"frame 2.000000", "scores"});
  EXPECT_EQ(evaluator.detection().frames(), 1U);
}

TEST(SequenceEvaluator, ScoresPairsByEqualIds) {
  SequenceEvaluator evaluator;
  const LineSegments first = {line(1, 1, 9, 9, kNoScore, 4), line(1, 2, 9, 9, kNoScore, 5),
                              line(1, 3, 9, 9, kNoScore, 6), line(1, 4, 9, 9)};
  const LineSegments second = {line(1, 1, 9, 9, kNoScore, 6), line(1, 2, 9, 9, kNoScore, 4),
                               line(1, 3, 9, 9, kNoScore, 8), line(1, 4, 9, 9)};
  // True pairs (0, 1) and (2, 0); lines without an id are never a true pair.
  MatchSet matches = matchSet(kSecond, 2 * kSecond, "ground_truth", {{0, 1}, {2, 2}, {3, 3}});
  matches.processing_time = 0.5;
  const PairRecord record = evaluator.addPair(matches, first, second);
  EXPECT_EQ(record.first_stamp, kSecond);
  EXPECT_EQ(record.stamp, 2 * kSecond);
  EXPECT_EQ(record.processing_time, 0.5);
  expectCounts(record.counts, 1, 3, 2);
  evaluator.addPair(matchSet(2 * kSecond, 3 * kSecond, "ground_truth", {{0, 0}}), first, first);
  expectCounts(evaluator.association().classification(), 2, 4, 5);
}

TEST(SequenceEvaluator, RefusesMatchesBeyondTheLines) {
  SequenceEvaluator evaluator;
  const LineSegments two = handTruth(kSecond).lines;
  for (const LineMatch& match : {LineMatch{2, 0}, LineMatch{0, 2}, LineMatch{4294967295U, 0}}) {
    expectError(
        [&] {
          evaluator.addPair(matchSet(kSecond, 2 * kSecond, "ground_truth", {{0, 0}, match}), two,
                            two);
        },
        {"1.000000 and 2.000000",
         "(" + std::to_string(match.first) + ", " + std::to_string(match.second) + ")",
         "2 and 2 lines"});
  }
  EXPECT_EQ(evaluator.association().pairs(), 0U);
}

TEST(SequenceEvaluator, NamesTheFrameWithARepeatedId) {
  SequenceEvaluator evaluator;
  LineSegments twice = handTruth(kSecond).lines;
  twice[1].id = 0;
  const LineSegments good = handTruth(kSecond).lines;
  const MatchSet matches = matchSet(kSecond, 2 * kSecond, "ground_truth", {{0, 0}});
  expectError<GroundTruthError>([&] { evaluator.addPair(matches, twice, good); },
                                {"frame 1.000000", "row 1", "id 0"});
  expectError<GroundTruthError>([&] { evaluator.addPair(matches, good, twice); },
                                {"frame 2.000000", "row 1", "id 0"});
  EXPECT_EQ(evaluator.association().pairs(), 0U);
}

}  // namespace
}  // namespace evolin
