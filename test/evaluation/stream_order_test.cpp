// Which frame begins a pass: inputs that start midway or sleep, late frames and mere disorder.
#include <gtest/gtest.h>

#include "evolin_ros/evaluation/stream_evaluator.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::expectCounts;
using test::handLines;
using test::handTruth;
using test::kStructural5;
using test::matchSet;

TEST(StreamEvaluator, TheNewestFrameAgainAfterALateOneIsADuplicate) {
  StreamEvaluator stream;
  for (const Stamp stamp : {1, 3, 2, 3, 4}) {
    stream.addLines(handLines(stamp));
  }
  for (const Stamp stamp : {1, 2, 3, 4}) stream.addGroundTruth(handTruth(stamp));
  EXPECT_EQ(stream.pass(), 1);
  const Report report = stream.report(true);
  EXPECT_EQ(report.frames.size(), 4U);
  EXPECT_EQ(report.coverage.evaluated, 4U);
  EXPECT_EQ(report.coverage.dropped, 1U);
  expectCounts(report.detection[kStructural5].counts, 4, 12, 8);
}

TEST(StreamEvaluator, AFrameThatWasThereBeforeTheNewestBeginsAPass) {
  // The first pass lost frame 2; the second begins with it and is recognised by frame 3.
  StreamEvaluator stream;
  for (const Stamp stamp : {1, 3, 4, 5}) stream.addLines(handLines(stamp));
  EXPECT_FALSE(stream.addLines(handLines(2)).new_pass);
  EXPECT_TRUE(stream.addLines(handLines(3)).new_pass);
  for (const Stamp stamp : {4, 5}) stream.addLines(handLines(stamp));
  EXPECT_EQ(stream.pass(), 2);
  EXPECT_EQ(stream.report(true).coverage.seen, 3U);
  EXPECT_EQ(stream.previousReport()->coverage.seen, 5U);
}

TEST(StreamEvaluator, AnInputThatStartedMidwayFollowsTheLoop) {
  StreamEvaluator stream;
  for (Stamp stamp = 1; stamp <= 40; ++stamp) {
    stream.addImage(stamp);
    stream.addGroundTruth(handTruth(stamp));
    if (stamp > 20) stream.addLines(handLines(stamp));
  }
  for (Stamp stamp = 1; stamp <= 40; ++stamp) {
    stream.addImage(stamp);
    stream.addGroundTruth(handTruth(stamp));
    stream.addLines(handLines(stamp));
  }
  EXPECT_EQ(stream.pass(), 2);
  EXPECT_EQ(stream.previousReport()->coverage.evaluated, 20U);
  EXPECT_EQ(stream.report(true).coverage.evaluated, 40U);
}

TEST(StreamEvaluator, AnInputThatSleptThroughPassesCatchesUp) {
  StreamEvaluator stream;
  stream.addLines(handLines(5));
  for (int pass = 1; pass <= 6; ++pass) {
    for (const Stamp stamp : {4, 5, 6}) stream.addImage(stamp);
  }
  EXPECT_EQ(stream.pass(), 6);
  // Back in time once: the pass before the newest. Once more: the newest.
  stream.addLines(handLines(4));
  EXPECT_EQ(stream.previousReport()->frames.at(0).lines, 3U);
  stream.addLines(handLines(4 - 1));
  stream.addLines(handLines(4));
  EXPECT_EQ(stream.pass(), 6);
  EXPECT_EQ(stream.report(true).frames.front().stamp, 3);
  EXPECT_EQ(stream.report(true).coverage.no_ground_truth, 2U);
}

TEST(StreamEvaluator, DisorderIsNoJump) {
  StreamEvaluator stream;
  for (const Stamp stamp : {1, 2, 3, 4, 5, 6, 7, 8}) stream.addGroundTruth(handTruth(stamp));
  for (const Stamp stamp : {1, 3, 2, 6, 5, 4, 8, 7}) stream.addLines(handLines(stamp));
  for (const Stamp stamp : {2, 4, 3, 5, 8, 6, 7}) {
    stream.addMatches(matchSet(stamp - 1, stamp, "ground_truth", {{0, 0}}));
  }
  EXPECT_EQ(stream.pass(), 1);
  const Report report = stream.report(true);
  EXPECT_EQ(report.coverage.evaluated, 8U);
  EXPECT_EQ(report.pairs.evaluated, 7U);
}

TEST(StreamEvaluator, DisorderAtTheStartIsNoJumpWhereAnotherInputKnowsTheFrame) {
  for (const bool known : {true, false}) {
    StreamEvaluator stream;
    for (Stamp stamp = known ? 1 : 2; stamp <= 4; ++stamp) stream.addImage(stamp);
    EXPECT_FALSE(stream.addLines(handLines(2)).new_pass);
    EXPECT_EQ(stream.addLines(handLines(1)).new_pass, !known);
    stream.addLines(handLines(3));
    EXPECT_EQ(stream.pass(), known ? 1 : 2);
    EXPECT_EQ(stream.coverage().seen, known ? 4U : 2U);
  }
}

}  // namespace
}  // namespace evolin
