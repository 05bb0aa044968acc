// Detection on segments as vectors, computed by hand, and what it refuses.
#include "evolin_ros/metrics/vectorized.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "evolin_ros/base/error.h"
#include "test/metrics/vectorized_support.h"

namespace evolin {
namespace {

using test::countsOf;
using test::expectCounts;
using test::kOrthogonal5;
using test::kSettings;
using test::kStructural5;
using test::kUnit;
using test::segment;

TEST(VectorizedMetrics, SettingsAreDistancesTimesThresholds) {
  const VectorizedMetrics metrics;
  ASSERT_EQ(metrics.settings().size(), kSettings);
  EXPECT_EQ(metrics.settings()[0].distance, LineDistance::kOrthogonal);
  EXPECT_EQ(metrics.settings()[0].threshold, 5);
  EXPECT_EQ(metrics.settings()[4].distance, LineDistance::kStructural);
  EXPECT_EQ(metrics.settings()[4].threshold, 10);
}

TEST(VectorizedMetrics, ScalesEachAxisOnItsOwn) {
  // 10 pixels of 640 x 480 are 2 scaled pixels in x and 2 2/3 in y: both ends give 4 and 5 1/3.
  const LineSegments truth = {segment(100, 100, 300, 200)};
  const ImageSize size{640, 480};
  EXPECT_EQ(countsOf({segment(110, 100, 310, 200)}, truth, Protocol::kEvolin, kStructural5, size)
                .true_positives,
            1U);
  EXPECT_EQ(countsOf({segment(100, 110, 300, 210)}, truth, Protocol::kEvolin, kStructural5, size)
                .true_positives,
            0U);
}

TEST(VectorizedMetrics, ThresholdIsExcludedByEvolinAndIncludedByPaper) {
  const LineSegments truth = {segment(10, 10, 50, 30)};
  const LineSegments five_away = {segment(15, 10, 50, 30)};
  EXPECT_EQ(countsOf(five_away, truth, Protocol::kEvolin, kStructural5).true_positives, 0U);
  EXPECT_EQ(countsOf(five_away, truth, Protocol::kPaper, kStructural5).true_positives, 1U);
}

TEST(VectorizedMetrics, EvolinDropsHorizontalAndVerticalPredictionsAndPaperKeepsThem) {
  const LineSegments truth = {segment(10, 10, 50, 10.5), segment(10, 20, 10.5, 60)};
  const LineSegments predicted = {segment(10, 10, 50, 10), segment(10, 20, 10, 60),
                                  segment(70, 70, 70, 70)};
  expectCounts(countsOf(predicted, truth, Protocol::kEvolin, kStructural5), 0, 0, 2);
  expectCounts(countsOf(predicted, truth, Protocol::kPaper, kStructural5), 2, 2, 2);
}

TEST(VectorizedMetrics, CountsWhatTheProtocolDrops) {
  const LineSegments predicted = {segment(10, 10, 50, 10), segment(10, 20, 10, 60),
                                  segment(70, 70, 70, 70), segment(1, 2, 3, 4)};
  const auto dropped = [&](Protocol protocol) {
    VectorizedMetrics all(test::optionsOf(protocol));
    VectorizedMetrics other = all;
    all.addFrame(0, "0000", kUnit, predicted, {}, false);
    other.addFrame(1, "0001", kUnit, predicted, {}, false);
    all.merge(other);
    const std::size_t count = all.dropped();
    all.reset();
    EXPECT_EQ(all.dropped(), 0U);
    return count;
  };
  EXPECT_EQ(dropped(Protocol::kEvolin), 6U);
  EXPECT_EQ(dropped(Protocol::kPaper), 2U);
}

TEST(VectorizedMetrics, HorizontalGroundTruthStays) {
  expectCounts(countsOf({segment(10, 10, 50, 10.1)}, {segment(10, 10, 50, 10)}, Protocol::kEvolin,
                        kOrthogonal5),
               1, 1, 1);
}

TEST(VectorizedMetrics, EvolinClampsCoordinatesAndPaperClipsSegments) {
  // Clipped, the prediction is the truth; clamped it turns to (0,20)-(40,60), 20 off at one end.
  const LineSegments predicted = {segment(-20, 20, 40, 80)};
  const LineSegments truth = {segment(0, 40, 40, 80)};
  EXPECT_EQ(countsOf(predicted, truth, Protocol::kEvolin, kStructural5).true_positives, 0U);
  EXPECT_EQ(countsOf(predicted, truth, Protocol::kPaper, kStructural5).true_positives, 1U);
}

TEST(VectorizedMetrics, ClampsToTheLastPixelBut1) {
  // 200 becomes 127, one off the truth at 128 at each end.
  const LineSegments truth = {segment(128, 10, 100, 128)};
  const LineSegments predicted = {segment(200, 10, 100, 200)};
  VectorizedOptions options;
  options.distances = {LineDistance::kStructural};
  options.distance_thresholds = {1.9375, 2.0625};
  VectorizedMetrics metrics(options);
  metrics.addFrame(0, "0000", kUnit, predicted, truth, false);
  EXPECT_EQ(metrics.classification(0).true_positives, 0U);
  EXPECT_EQ(metrics.classification(1).true_positives, 1U);
}

TEST(VectorizedMetrics, PredictionOutsideTheImageIsDropped) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    expectCounts(
        countsOf({segment(-30, 10, -10, 40)}, {segment(1, 10, 2, 40)}, protocol, kStructural5), 0,
        0, 1);
  }
}

TEST(VectorizedMetrics, TiesGoToTheLowestRow) {
  // Both true lines are 2 from the first prediction, which takes row 0; so nothing is left for the
  // second one, whose nearest line is row 0 too.
  const LineSegments truth = {segment(10, 10, 50, 30), segment(10, 12, 50, 32)};
  const LineSegments middle = {segment(10, 11, 50, 31)};
  VectorizedMetrics metrics;
  LineSegments predicted = middle;
  predicted.push_back(segment(10, 9, 50, 28));
  metrics.addFrame(0, "0000", kUnit, predicted, truth, false);
  expectCounts(metrics.classification(kStructural5), 1, 2, 2);
  // With the rows exchanged the tie goes to the other line, and both are right.
  metrics.addFrame(1, "0001", kUnit, predicted, {truth[1], truth[0]}, false);
  expectCounts(metrics.classification(kStructural5), 3, 4, 4);
}

TEST(VectorizedMetrics, OnlyTheBestPredictionOfALineIsRight) {
  const LineSegments truth = {segment(10, 10, 50, 30)};
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(10, 11, 50, 30, 0.2), segment(12, 11, 50, 30, 0.9)},
                   truth, true);
  expectCounts(metrics.classification(kStructural5), 1, 2, 1);
  // The better score won, though it is farther away.
  expectCounts(metrics.classification(kStructural5, 0.5), 1, 1, 1);
}

TEST(VectorizedMetrics, ABetterScoreBeyondTheThresholdTakesNothing) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(10, 17, 50, 30, 0.9), segment(10, 11, 50, 30, 0.1)},
                   {segment(10, 10, 50, 30)}, true);
  expectCounts(metrics.classification(kStructural5), 1, 2, 1);
  expectCounts(metrics.classification(kStructural5, 0.5), 0, 1, 1);
  expectCounts(metrics.classification(kStructural5 + 1, 0.5), 1, 1, 1);
}

TEST(VectorizedMetrics, EqualScoresGoToTheLowerRow) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(10, 12, 50, 30, 0.5), segment(10, 11, 50, 30, 0.5)},
                   {segment(10, 10, 50, 30)}, true);
  EXPECT_EQ(metrics.curve(kStructural5).precision, (std::vector<double>{1, 0.5}));
}

TEST(VectorizedMetrics, FramesWithoutPredictionsOrWithoutTruthCount) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {}, {segment(10, 10, 50, 30), segment(1, 2, 30, 40)}, true);
  EXPECT_FALSE(metrics.scored());
  metrics.addFrame(1, "0001", kUnit, {segment(10, 10, 50, 30)}, {}, false);
  expectCounts(metrics.classification(kOrthogonal5), 0, 1, 2);
}

TEST(VectorizedMetrics, ScoreFilterExcludesItsThreshold) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(10, 10, 50, 30, 0.5), segment(60, 10, 90, 30, 0.75)},
                   {}, true);
  EXPECT_EQ(metrics.classification(0, 0.5).predicted, 1U);
  EXPECT_EQ(metrics.classification(0, 0.25).predicted, 2U);
}

TEST(VectorizedMetrics, BadGroundTruthNamesFrameAndRow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const LineSegment& bad :
       {segment(5, 5, 5, 5), segment(0, 0, 641, 10), segment(0, 0, 10, 480.5),
        segment(-0.6, 0, 10, 10), segment(nan, 0, 10, 10)}) {
    VectorizedMetrics metrics;
    try {
      metrics.addFrame(3, "0003", {640, 480}, {segment(1, 1, 2, 2, 0.5)},
                       {segment(1, 1, 20, 20), bad}, true);
      FAIL() << "accepted";
    } catch (const GroundTruthError& error) {
      EXPECT_EQ(error.frame(), "0003");
      EXPECT_EQ(error.row(), 1U);
    }
    EXPECT_EQ(metrics.frames(), 0U);
    EXPECT_EQ(metrics.classification(0).predicted, 0U);
    EXPECT_FALSE(metrics.scored());
  }
}

TEST(VectorizedMetrics, GroundTruthMayTouchTheBorder) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", {640, 480}, {}, {segment(-0.5, -0.5, 640, 480)}, false);
  EXPECT_EQ(metrics.classification(0).ground_truth, 1U);
}

TEST(VectorizedMetrics, BadPredictionsAreRefused) {
  const double infinity = std::numeric_limits<double>::infinity();
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(1, 1, 2, 2, 0.5)}, {}, true);
  EXPECT_THROW(metrics.addFrame(1, "0001", kUnit, {segment(1, infinity, 2, 2, 0.5)}, {}, true),
               Error);
  EXPECT_THROW(metrics.addFrame(1, "0001", kUnit, {segment(1, 1, 2, 2)}, {}, true), Error);
  EXPECT_THROW(metrics.addFrame(1, "0001", kUnit, {segment(1, 1, 2, 2)}, {}, false), Error);
  EXPECT_THROW(metrics.addFrame(1, "0001", {0, 128}, {}, {}, true), Error);
  EXPECT_THROW(metrics.addFrame(0, "0000", kUnit, {}, {}, true), Error);
  EXPECT_EQ(metrics.frames(), 1U);
}

TEST(VectorizedMetrics, ScoreFilterNeedsScores) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, {segment(1, 1, 2, 2)}, {}, false);
  EXPECT_THROW(metrics.classification(0, 0.5), Error);
  EXPECT_THROW(metrics.frameClassifications(0, 0.5), Error);
}

TEST(VectorizedMetrics, OptionsOutOfRangeAreRefused) {
  VectorizedOptions options;
  for (const double threshold : {0.0, -5.0, std::nan(""), HUGE_VAL}) {
    options.distance_thresholds = {5, threshold};
    EXPECT_THROW(VectorizedMetrics{options}, Error) << threshold;
  }
  options.distance_thresholds = {};
  EXPECT_THROW(VectorizedMetrics{options}, Error);
  options.distance_thresholds = std::vector<double>(17, 5);
  EXPECT_THROW(VectorizedMetrics{options}, Error);
}

TEST(VectorizedMetrics, KeepsThirtyTwoSettings) {
  VectorizedOptions options;
  options.distance_thresholds.clear();
  for (int k = 1; k <= 16; ++k) {
    options.distance_thresholds.push_back(k);
  }
  VectorizedMetrics metrics(options);
  metrics.addFrame(0, "0000", kUnit, {segment(10, 25.5, 50, 30, 0.5)}, {segment(10, 10, 50, 30)},
                   true);
  EXPECT_EQ(metrics.classification(30).true_positives, 0U);  // structural, 15
  EXPECT_EQ(metrics.classification(31).true_positives, 1U);  // structural, 16
}

}  // namespace
}  // namespace evolin
