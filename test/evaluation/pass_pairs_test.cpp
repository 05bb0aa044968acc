// What becomes of the matches of a pass: evaluated, due, or skipped with a note.
#include <gtest/gtest.h>

#include <limits>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::detected;
using test::handLines;
using test::handTruth;
using test::matchSet;
using test::withBuffer;

TEST(PassPairs, AFullBufferOfMatchesCountsTheOldest) {
  PassEvaluation pass(withBuffer(5));
  for (Stamp stamp = 1; stamp <= 12; ++stamp) {
    pass.addMatches(matchSet(stamp, stamp + 1, "ground_truth", {{0, 0}}));
  }
  const Report report = pass.report(true);
  EXPECT_EQ(report.pairs.no_ground_truth, 12U);
  EXPECT_EQ(report.pairs.evaluated, 0U);
  EXPECT_EQ(whyNoAssociation(report), "not evaluated: no ground truth for the matched frames");
}

TEST(PassPairs, MatchesBetweenDetectedLinesAreNotEvaluated) {
  for (const bool ground_truth_first : {true, false}) {
    PassEvaluation pass;
    if (ground_truth_first) {
      pass.addGroundTruth(handTruth(1));
      pass.addGroundTruth(handTruth(2));
    }
    pass.addLines(handLines(1));
    pass.addLines(handLines(2));
    pass.addMatches(matchSet(1, 2, "detector", {{0, 0}}));
    EXPECT_EQ(pass.report(false).pairs.detected_lines, 1U);
    if (!ground_truth_first) {
      pass.addGroundTruth(handTruth(1));
      pass.addGroundTruth(handTruth(2));
    }
    const Report report = pass.report(true);
    EXPECT_EQ(report.pairs.detected_lines, 1U);
    EXPECT_EQ(report.pairs.evaluated, 0U);
    EXPECT_FALSE(report.pairs_expected.has_value());
    EXPECT_EQ(whyNoAssociation(report), "not evaluated: detected lines");
    EXPECT_NE(toMarkdown(report).find("not evaluated: detected lines"), std::string::npos);
  }
}

TEST(PassPairs, GroundTruthWithoutIdsGivesAReasonAndNoZero) {
  PassEvaluation pass;
  for (const Stamp stamp : {1, 2}) {
    LineSet truth = handTruth(stamp);
    for (LineSegment& line : truth.lines) line.id = kNoId;
    pass.addGroundTruth(truth);
  }
  pass.addMatches(matchSet(1, 2, "ground_truth", {{0, 0}}));
  const Report report = pass.report(true);
  EXPECT_EQ(report.pairs.without_ids, 1U);
  EXPECT_EQ(report.pairs.evaluated, 0U);
  EXPECT_EQ(whyNoAssociation(report),
            "not evaluated: the ground truth has no ids, its true matches are unknown");
  EXPECT_NE(toJson(report).find("\"precision\": null"), std::string::npos);
}

TEST(PassPairs, UnusableMatchesAreSkippedWithANote) {
  PassEvaluation pass;
  for (const Stamp stamp : {1, 2, 3}) pass.addGroundTruth(handTruth(stamp));
  LineSet twice = handTruth(4);
  twice.lines[1].id = 0;
  pass.addGroundTruth(twice);
  EXPECT_EQ(pass.addMatches(matchSet(1, 2, "ground_truth", {{0, 7}})).notes.size(), 1U);
  EXPECT_EQ(pass.addMatches(matchSet(3, 4, "ground_truth", {{0, 0}})).notes.size(), 1U);
  const Report report = pass.report(true);
  EXPECT_EQ(report.pairs.skipped, 1U);
  EXPECT_EQ(report.pairs.bad_ground_truth, 1U);
  EXPECT_EQ(report.pairs.evaluated, 0U);
  EXPECT_EQ(whyNoAssociation(report), "not evaluated: no usable pair, see the notes");
  EXPECT_NE(report.notes.at(0).find("(0, 7)"), std::string::npos);
  EXPECT_NE(report.notes.at(1).find("id 0"), std::string::npos);
}

TEST(PassPairs, ExpectsPairsByTheFrameStep) {
  PassOptions options;
  options.frame_step = 3;
  PassEvaluation pass(options);
  pass.addMatches(matchSet(1, 4, "ground_truth", {}));
  for (const Stamp stamp : {1, 2}) pass.addGroundTruth(handTruth(stamp));
  EXPECT_EQ(pass.report(false).pairs_expected, 0U);
  for (const Stamp stamp : {3, 4, 5}) pass.addGroundTruth(handTruth(stamp));
  EXPECT_EQ(pass.report(false).pairs_expected, 2U);
  EXPECT_EQ(pass.report(false).pairs.evaluated, 1U);
}

TEST(PassPairs, MatchesOfOtherLinesOrBackwardsAreSkippedAndNamed) {
  PassEvaluation pass;
  for (const Stamp stamp : {1, 2}) {
    pass.addGroundTruth(handTruth(stamp));
    pass.addLines(handLines(stamp));
  }
  EXPECT_EQ(pass.addMatches(matchSet(1, 2, "another_detector", {{0, 0}})).notes.size(), 1U);
  EXPECT_EQ(pass.addMatches(matchSet(2, 2, "detector", {{0, 0}})).notes.size(), 1U);
  EXPECT_EQ(pass.addMatches(matchSet(2, 1, "detector", {{0, 0}})).notes.size(), 1U);
  const Report report = pass.report(true);
  EXPECT_EQ(report.pairs.skipped, 3U);
  EXPECT_EQ(report.detected_pairs.evaluated, 0U);
  EXPECT_NE(report.notes.at(0).find("'another_detector'"), std::string::npos) << report.notes[0];
}

}  // namespace
}  // namespace evolin
