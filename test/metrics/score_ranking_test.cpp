// Average precision and precision-recall curves.
#include "evolin_ros/metrics/score_ranking.h"

#include <gtest/gtest.h>

#include <vector>

#include "test/metrics/vectorized_support.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::kOrthogonal5;
using test::kSettings;
using test::kStructural5;
using test::kUnit;
using test::optionsOf;
using test::segment;

TEST(AveragePrecision, OfOnePerfectPredictionIsZeroByEvolinAndOneByPaper) {
  const LineSegments truth = {segment(10, 10, 50, 30)};
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    VectorizedMetrics metrics(optionsOf(protocol));
    metrics.addFrame(0, "0000", kUnit, {segment(10, 10, 50, 30, 0.9)}, truth, true);
    EXPECT_DOUBLE_EQ(*metrics.averagePrecision(kStructural5),
                     protocol == Protocol::kEvolin ? 0.0 : 1.0);
  }
}

TEST(AveragePrecision, OfTwoPerfectPredictionsIsAHalfByEvolin) {
  const LineSegments lines = {segment(10, 10, 50, 30, 0.9), segment(60, 70, 90, 120, 0.8)};
  VectorizedMetrics metrics;
  metrics.addFrame(0, "0000", kUnit, lines, lines, true);
  EXPECT_DOUBLE_EQ(*metrics.averagePrecision(kOrthogonal5), 0.5);
}

TEST(AveragePrecision, AddsTrapezoids) {
  // Hit, miss, hit on two lines: (1/2, 1), (1/2, 1/2), (1, 2/3).
  VectorizedMetrics metrics;
  metrics.addFrame(
      0, "0000", kUnit,
      {segment(60, 70, 90, 120, 0.1), segment(10, 10, 50, 30, 0.9), segment(20, 100, 40, 120, 0.5)},
      {segment(10, 10, 50, 30), segment(60, 70, 90, 120)}, true);
  const PrecisionRecallCurve curve = metrics.curve(kStructural5);
  EXPECT_EQ(curve.recall, (std::vector<double>{0.5, 0.5, 1}));
  EXPECT_EQ(curve.precision, (std::vector<double>{1, 0.5, 2.0 / 3}));
  EXPECT_DOUBLE_EQ(*metrics.averagePrecision(kStructural5), 0.5 * (0.5 + 2.0 / 3) / 2);
}

TEST(AveragePrecision, EqualsTheAreaUnderTheCurve) {
  test::RandomLines random(11);
  VectorizedMetrics metrics;
  for (std::uint32_t frame = 0; frame < 5; ++frame) {
    const LineSegments truth = random.anywhere(20, 128, 128);
    metrics.addFrame(frame, "f", kUnit, random.detectionsOf(truth, 60, 3), truth, true);
  }
  for (std::size_t setting = 0; setting < kSettings; ++setting) {
    const PrecisionRecallCurve curve = metrics.curve(setting);
    double area = 0;
    for (std::size_t i = 1; i < curve.recall.size(); ++i) {
      area += (curve.recall[i] - curve.recall[i - 1]) *
              (curve.precision[i] + curve.precision[i - 1]) / 2;
    }
    EXPECT_NEAR(*metrics.averagePrecision(setting), area, 1e-12);
    EXPECT_GT(area, 0.01);
  }
}

TEST(AveragePrecision, IsEmptyWithoutScoresPredictionsOrTruth) {
  VectorizedMetrics unscored;
  unscored.addFrame(0, "0000", kUnit, {segment(1, 1, 2, 2)}, {segment(1, 1, 2, 2)}, false);
  EXPECT_FALSE(unscored.averagePrecision(0));
  EXPECT_TRUE(unscored.curve(0).recall.empty());
  VectorizedMetrics no_predictions;
  no_predictions.addFrame(0, "0000", kUnit, {}, {segment(1, 1, 2, 2)}, true);
  EXPECT_FALSE(no_predictions.averagePrecision(0));
  VectorizedMetrics no_truth;
  no_truth.addFrame(0, "0000", kUnit, {segment(1, 1, 2, 2, 0.5)}, {}, true);
  EXPECT_FALSE(no_truth.averagePrecision(0));
  EXPECT_EQ(no_truth.curve(0).recall, std::vector<double>{0});
  EXPECT_FALSE(VectorizedMetrics().averagePrecision(0));
}

}  // namespace
}  // namespace evolin
