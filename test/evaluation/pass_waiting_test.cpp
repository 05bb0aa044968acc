// What a pass still waits for.
#include <gtest/gtest.h>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::handLines;
using test::handTruth;
using test::matchSet;

TEST(PassWaiting, ForLinesAndForTheNewestMatches) {
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

TEST(PassWaiting, ForNothingThatItsMakersHaveLeftOut) {
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kAssociation};
  PassEvaluation pass(options);
  pass.addImage(1);
  pass.addGroundTruth(handTruth(2));
  pass.leaveOutLines(1);
  EXPECT_TRUE(pass.waiting()) << "for lines of 2";
  pass.leaveOutLines(2);
  EXPECT_FALSE(pass.waiting());
  pass.leaveOutLines(3);
  pass.addGroundTruth(handTruth(3));
  EXPECT_FALSE(pass.waiting()) << "told before";
  pass.addLines(handLines(1));
  pass.addLines(handLines(2));
  pass.addMatches(matchSet(1, 2, "detector", {}));
  pass.addLines(handLines(4));
  EXPECT_TRUE(pass.waiting()) << "for matches to 4";
  pass.leaveOutMatches(4);
  EXPECT_FALSE(pass.waiting());
  pass.addLines(handLines(5));
  EXPECT_TRUE(pass.waiting());
  const CoverageCounts counts = pass.coverage();
  EXPECT_EQ(counts.seen, 5U) << "what is left out is no frame of its own";
  EXPECT_EQ(counts.evaluated, 1U);
  EXPECT_EQ(counts.waiting, 4U);
}

TEST(PassWaiting, OnlyForWhatMayCome) {
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kAssociation};
  PassEvaluation pass(options);
  MayCome nothing;
  nothing.lines = nothing.matches = false;
  MayCome first_matches = nothing;
  first_matches.first_matches = true;
  MayCome more_matches = nothing;
  more_matches.matches = true;
  EXPECT_TRUE(pass.waiting(first_matches)) << "nobody knows yet what comes";
  EXPECT_FALSE(pass.waiting(nothing));
  pass.addImage(1);
  EXPECT_TRUE(pass.waiting());
  EXPECT_FALSE(pass.waiting(nothing));
  EXPECT_FALSE(pass.waiting(first_matches)) << "there is nothing to be matched";
  pass.addLines(handLines(1));
  EXPECT_TRUE(pass.waiting(first_matches));
  pass.leaveOutMatches(1);
  EXPECT_FALSE(pass.waiting(first_matches)) << "nothing before it";
  pass.addLines(handLines(2));
  EXPECT_TRUE(pass.waiting(first_matches));
  EXPECT_FALSE(pass.waiting(more_matches)) << "there were none";
  pass.addMatches(matchSet(1, 2, "detector", {}));
  pass.addLines(handLines(3));
  EXPECT_TRUE(pass.waiting(more_matches));
  EXPECT_FALSE(pass.waiting(nothing));
}

}  // namespace
}  // namespace evolin
