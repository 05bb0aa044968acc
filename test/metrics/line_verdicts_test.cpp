// Verdicts on single lines: cases by hand, and agreement with the metric's own counts.
#include "evolin_ros/metrics/line_verdicts.h"

#include <gtest/gtest.h>

#include "test/metrics/vectorized_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::kUnit;
using test::segment;
using Found = std::vector<bool>;
using Verdicts = std::vector<LineVerdict>;

constexpr LineVerdict kTrue = LineVerdict::kTruePositive;
constexpr LineVerdict kFalse = LineVerdict::kFalsePositive;
constexpr LineVerdict kDropped = LineVerdict::kDropped;
constexpr VectorizedSetting kStructuralFive{LineDistance::kStructural, 5};

TEST(JudgeLines, NamesTheRowOfEveryVerdict) {
  const LineSegments predicted = {segment(70, 10, 90, 12), segment(10, 10, 40, 10),
                                  segment(11, 11, 41, 16), segment(10, 12, 40, 17)};
  const LineSegments truth = {segment(100, 100, 120, 110), segment(40, 17, 10, 12)};
  const LineVerdicts verdicts =
      judgeLines(kStructuralFive, Protocol::kEvolin, kUnit, predicted, truth, false);
  EXPECT_EQ(verdicts.predicted, (Verdicts{kFalse, kDropped, kFalse, kTrue}));
  EXPECT_EQ(verdicts.found, (Found{false, true}));
  EXPECT_EQ(verdicts.count(kFalse), 2U);
  EXPECT_EQ(verdicts.misses(), 1U);
  const Classification counts = verdicts.counts();
  EXPECT_EQ(counts.true_positives, 1U);
  EXPECT_EQ(counts.predicted, 3U) << "a dropped line is none";
  EXPECT_EQ(counts.ground_truth, 2U);
}

TEST(JudgeLines, TheHigherScoreTakesTheLine) {
  const LineSegments truth = {segment(10, 10, 40, 20)};
  const LineSegments predicted = {segment(10, 10, 40, 20, 0.3), segment(11, 10, 40, 20, 0.9)};
  const LineVerdicts verdicts =
      judgeLines(kStructuralFive, Protocol::kEvolin, kUnit, predicted, truth, true);
  EXPECT_EQ(verdicts.predicted, (Verdicts{kFalse, kTrue}));
  EXPECT_EQ(verdicts.found, (Found{true}));
}

TEST(JudgeLines, FollowsTheProtocolAtTheThresholdAndOnLevelLines) {
  const LineSegments truth = {segment(10, 10, 40, 10)};
  const LineSegments level = {segment(10, 13, 40, 12)};  // at exactly 5
  EXPECT_EQ(judgeLines(kStructuralFive, Protocol::kEvolin, kUnit, level, truth, false).predicted,
            Verdicts{kFalse});
  EXPECT_EQ(judgeLines(kStructuralFive, Protocol::kPaper, kUnit, level, truth, false).predicted,
            Verdicts{kTrue});
  EXPECT_EQ(judgeLines(kStructuralFive, Protocol::kEvolin, kUnit, truth, truth, false).predicted,
            Verdicts{kDropped});
  EXPECT_EQ(judgeLines(kStructuralFive, Protocol::kPaper, kUnit, truth, truth, false).predicted,
            Verdicts{kTrue});
}

TEST(JudgeLines, AgreesWithTheMetricsCounts) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomLines random(seed);
    const LineSegments truth = random.anywhere(1 + random.index(60), 640, 480);
    const LineSegments predicted = random.detectionsOf(truth, random.index(120), 30);
    const bool scored = seed % 2 == 0;
    const Protocol protocol = seed % 3 == 0 ? Protocol::kPaper : Protocol::kEvolin;
    VectorizedMetrics metrics(test::optionsOf(protocol));
    metrics.addFrame(0, "0000", {640, 480}, predicted, truth, scored);
    for (std::size_t k = 0; k < metrics.settings().size(); ++k) {
      const LineVerdicts verdicts =
          judgeLines(metrics.settings()[k], protocol, {640, 480}, predicted, truth, scored);
      ASSERT_EQ(verdicts.predicted.size(), predicted.size());
      test::expectCounts(metrics.classification(k), verdicts.count(kTrue),
                         verdicts.count(kTrue) + verdicts.count(kFalse), truth.size());
      EXPECT_EQ(verdicts.misses(), truth.size() - verdicts.count(kTrue));
    }
  }
}

TEST(JudgeLines, RefusesWhatTheMetricRefuses) {
  test::expectError<GroundTruthError>(
      [] {
        judgeLines(kStructuralFive, Protocol::kEvolin, kUnit, {}, {segment(1, 1, 300, 300)}, false);
      },
      {"row 0", "128 x 128"});
  test::expectError<Error>(
      [] {
        judgeLines(kStructuralFive, Protocol::kEvolin, {0, 4}, {}, {}, false);
      },
      {"0 x 4"});
  test::expectError<Error>(
      [] {
        judgeLines({LineDistance::kStructural, 0}, Protocol::kEvolin, kUnit, {}, {}, false);
      },
      {"threshold 0", "positive"});
}

}  // namespace
}  // namespace evolin
