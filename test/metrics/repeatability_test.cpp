// Repeatability and localisation error, computed by hand, and what the metric refuses.
#include "evolin_ros/metrics/repeatability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/metrics/spatial_support.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::expectError;
using test::halfWallFrame;
using test::segment;
using test::wallFrame;

constexpr double kShift = 7;  // pixels that the second camera's image moves left

RepeatabilityOptions optionsOf(Protocol protocol, std::vector<LineDistance> distances,
                               std::vector<double> thresholds) {
  RepeatabilityOptions options;
  options.protocol = protocol;
  options.distances = std::move(distances);
  options.distance_thresholds = std::move(thresholds);
  options.frame_steps = {1};
  return options;
}

RepeatabilityOptions structural(Protocol protocol, double threshold = 5) {
  return optionsOf(protocol, {LineDistance::kStructural}, {threshold});
}

PairRepeatability measureOne(const SpatialFrame& first, const SpatialFrame& second,
                             double threshold = 5) {
  return RepeatabilityMetrics(structural(first.protocol, threshold)).measure(first, second).at(0);
}

// Projected into the second frame: (23,10)-(43,30).
const LineSegment kLine = segment(30, 10, 50, 30);
const LineSegment kTwoAway = segment(24, 10, 44, 30);
const LineSegment kFourAway = segment(25, 10, 45, 30);

TEST(RepeatabilityMetrics, SettingsHaveScoresSlowestAndStepsFastest) {
  RepeatabilityOptions options;
  options.distance_thresholds = {5, 10};
  options.frame_steps = {1, 10};
  options.score_thresholds = {0.2, 0.7};
  const RepeatabilityMetrics metrics(options);
  ASSERT_EQ(metrics.settings().size(), 16U);
  EXPECT_EQ(metrics.settings()[0].score_threshold, 0.2);
  EXPECT_EQ(metrics.settings()[0].distance, LineDistance::kOrthogonal);
  EXPECT_EQ(metrics.settings()[1].frame_step, 10);
  EXPECT_EQ(metrics.settings()[2].distance_threshold, 10);
  EXPECT_EQ(metrics.settings()[4].distance, LineDistance::kStructural);
  EXPECT_EQ(metrics.settings()[8].score_threshold, 0.7);
  EXPECT_EQ(metrics.settingsOf(10), (std::vector<std::size_t>{1, 3, 5, 7, 9, 11, 13, 15}));
  EXPECT_FALSE(RepeatabilityMetrics().settings()[0].score_threshold.has_value());
}

TEST(RepeatabilityMetrics, MeasuresBothDistancesInBothDirections) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const RepeatabilityMetrics metrics(
        optionsOf(protocol, {LineDistance::kOrthogonal, LineDistance::kStructural}, {1.75, 5}));
    const auto results =
        metrics.measure(wallFrame(protocol, {kLine}), wallFrame(protocol, {kTwoAway}, kShift));
    ASSERT_EQ(results.size(), 4U);
    for (const PairRepeatability& result : results) {
      EXPECT_EQ(result.lines, 2U);
    }
    // One pixel aside at 45 degrees: 1/sqrt(2) at each of an infinite line's two endpoints.
    for (const std::size_t orthogonal : {0U, 1U}) {
      EXPECT_EQ(results[orthogonal].repeatability(), 1);
      EXPECT_NEAR(results[orthogonal].localizationError(protocol), std::sqrt(2), 1e-12);
    }
    EXPECT_EQ(results[2].repeatability(), 0);
    EXPECT_EQ(results[2].localizationError(protocol), 0);
    EXPECT_EQ(results[3].repeatability(), 1);
    EXPECT_EQ(results[3].localizationError(protocol), 2);
    EXPECT_EQ(results[3].forward.count, 1U);
    EXPECT_EQ(results[3].backward.count, 1U);
  }
}

TEST(RepeatabilityMetrics, ThresholdIsExcludedByEvolinAndIncludedByPaper) {
  const auto count_at = [](Protocol protocol) {
    return measureOne(wallFrame(protocol, {kLine}), wallFrame(protocol, {kTwoAway}, kShift), 2)
        .forward.count;
  };
  EXPECT_EQ(count_at(Protocol::kEvolin), 0U);
  EXPECT_EQ(count_at(Protocol::kPaper), 1U);
}

TEST(RepeatabilityMetrics, ScalesEachAxisOnItsOwn) {
  // 256 x 128 pixels: two pixels in x are one scaled pixel, one in y is one.
  const auto distance_of = [](const LineSegment& detected) {
    const auto frame = [](const LineSegment& line) {
      return liftLines(Protocol::kEvolin, "wide", {line},
                       DepthMap(cv::Mat(128, 256, CV_32FC1, cv::Scalar(2))), test::wallCamera(),
                       Pose());
    };
    return measureOne(frame(kLine), frame(detected)).localizationError(Protocol::kEvolin);
  };
  EXPECT_EQ(distance_of(segment(32, 10, 52, 30)), 2);
  EXPECT_EQ(distance_of(segment(30, 11, 50, 31)), 2);
}

TEST(RepeatabilityMetrics, ErrorIsAveragedOverDirectionsByEvolinAndOverLinesByPaper) {
  // Forward: 2. Backward: 2 and 4.
  const auto measure_as = [](Protocol protocol) {
    return measureOne(wallFrame(protocol, {kLine}),
                      wallFrame(protocol, {kTwoAway, kFourAway}, kShift));
  };
  EXPECT_EQ(measure_as(Protocol::kEvolin).repeatability(), 1);
  EXPECT_EQ(measure_as(Protocol::kEvolin).localizationError(Protocol::kEvolin), 2.5);
  EXPECT_DOUBLE_EQ(measure_as(Protocol::kPaper).localizationError(Protocol::kPaper), 8.0 / 3);
}

TEST(RepeatabilityMetrics, LinesWithoutDepthCountAndCanBeFound) {
  const auto measure_as = [](Protocol protocol) {
    return measureOne(halfWallFrame(protocol, {kLine}, 20),
                      wallFrame(protocol, {kTwoAway, kFourAway}, kShift));
  };
  const PairRepeatability pair = measure_as(Protocol::kEvolin);
  EXPECT_EQ(pair.lines, 3U);
  EXPECT_EQ(pair.forward.count, 0U);
  EXPECT_EQ(pair.backward.count, 2U);
  EXPECT_DOUBLE_EQ(pair.repeatability(), 2.0 / 3);
  EXPECT_EQ(pair.localizationError(Protocol::kEvolin), 1.5);  // the empty direction counts as 0
  EXPECT_EQ(measure_as(Protocol::kPaper).localizationError(Protocol::kPaper), 3);
}

TEST(RepeatabilityMetrics, ZeroLengthDetectionsCountAndHarmNoOther) {
  const RepeatabilityMetrics metrics(
      optionsOf(Protocol::kEvolin, {LineDistance::kOrthogonal, LineDistance::kStructural}, {5}));
  const auto results =
      metrics.measure(wallFrame(Protocol::kEvolin, {kLine, segment(9, 9, 9, 9)}),
                      wallFrame(Protocol::kEvolin, {segment(80, 80, 80, 80), kTwoAway}, kShift));
  for (const PairRepeatability& result : results) {
    EXPECT_EQ(result.lines, 4U);
    EXPECT_EQ(result.forward.count, 1U);
    EXPECT_EQ(result.backward.count, 1U);
    EXPECT_EQ(result.repeatability(), 0.5);
  }
}

TEST(RepeatabilityMetrics, AxisParallelDetectionsAreTargetsUnderEvolinButNoSources) {
  const PairRepeatability pair =
      measureOne(wallFrame(Protocol::kEvolin, {segment(30, 20, 90, 21)}),
                 wallFrame(Protocol::kEvolin, {segment(23, 20, 83, 20)}, kShift));
  EXPECT_EQ(pair.forward.count, 1U);
  EXPECT_EQ(pair.backward.count, 0U);
  EXPECT_EQ(pair.repeatability(), 0.5);
}

TEST(RepeatabilityMetrics, LinesOutsideTheImageCountUnderPaper) {
  const PairRepeatability pair =
      measureOne(wallFrame(Protocol::kPaper, {kLine, segment(-9, 3, -4, 7)}),
                 wallFrame(Protocol::kPaper, {kTwoAway}, kShift));
  EXPECT_EQ(pair.lines, 3U);
  EXPECT_DOUBLE_EQ(pair.repeatability(), 2.0 / 3);
}

TEST(RepeatabilityMetrics, ScoresFilterSourcesTargetsAndCounts) {
  const auto scored_line = [](LineSegment line, double score) {
    line.score = score;
    return line;
  };
  RepeatabilityOptions options = structural(Protocol::kEvolin);
  options.score_thresholds = {0.1, 0.5, 0.8};
  const auto results = RepeatabilityMetrics(options).measure(
      wallFrame(Protocol::kEvolin, {scored_line(kLine, 0.9)}),
      wallFrame(Protocol::kEvolin, {scored_line(kTwoAway, 0.5), scored_line(kFourAway, 0.7)},
                kShift));
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0].lines, 3U);
  EXPECT_EQ(results[0].localizationError(Protocol::kEvolin), 2.5);
  EXPECT_EQ(results[1].lines, 2U);  // a score equal to the threshold does not pass
  EXPECT_EQ(results[1].repeatability(), 1);
  EXPECT_EQ(results[1].localizationError(Protocol::kEvolin), 4);
  EXPECT_EQ(results[2].lines, 1U);
  EXPECT_EQ(results[2].repeatability(), 0);
}

TEST(RepeatabilityMetrics, EmptyPairsCountAndAreNeverNaN) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    RepeatabilityMetrics metrics(structural(protocol));
    EXPECT_FALSE(metrics.figures(0).has_value());
    metrics.addPair(1, wallFrame(protocol, {}), wallFrame(protocol, {}, kShift));
    ASSERT_TRUE(metrics.figures(0).has_value());
    EXPECT_EQ(metrics.figures(0)->repeatability, 0);
    EXPECT_EQ(metrics.figures(0)->localization_error, 0);
    metrics.addPair(1, wallFrame(protocol, {kLine}), wallFrame(protocol, {}, kShift));
    EXPECT_EQ(metrics.figures(0)->repeatability, 0);
    metrics.addPair(1, wallFrame(protocol, {kLine}),
                    wallFrame(protocol, {kTwoAway, kFourAway}, kShift));
    EXPECT_EQ(metrics.pairs(1), 3U);
    EXPECT_DOUBLE_EQ(metrics.figures(0)->repeatability, 1.0 / 3);
    EXPECT_DOUBLE_EQ(metrics.figures(0)->localization_error,
                     protocol == Protocol::kEvolin ? 2.5 / 3 : 8.0 / 3);
  }
}

TEST(RepeatabilityMetrics, StepsAreKeptApart) {
  RepeatabilityOptions options = structural(Protocol::kEvolin);
  options.frame_steps = {1, 3};
  RepeatabilityMetrics metrics(options);
  const SpatialFrame first = wallFrame(Protocol::kEvolin, {kLine});
  metrics.addPair(1, first, wallFrame(Protocol::kEvolin, {kTwoAway}, kShift));
  metrics.addPair(3, first, wallFrame(Protocol::kEvolin, {}, kShift));
  metrics.addPair(3, first, wallFrame(Protocol::kEvolin, {kFourAway}, kShift));
  EXPECT_EQ(metrics.pairs(1), 1U);
  EXPECT_EQ(metrics.pairs(3), 2U);
  EXPECT_EQ(metrics.figures(0)->repeatability, 1);
  EXPECT_EQ(metrics.figures(1)->repeatability, 0.5);
  EXPECT_EQ(metrics.figures(1)->localization_error, 2);
}

TEST(RepeatabilityMetrics, RefusesOptionsThatMakeNoSense) {
  const auto refused = [](RepeatabilityOptions options, std::initializer_list<std::string> words) {
    expectError([&options] { RepeatabilityMetrics metrics(options); }, words);
  };
  RepeatabilityOptions options;
  options.distance_thresholds = {};
  refused(options, {"0 distance thresholds"});
  options.distance_thresholds = {5, -1};
  refused(options, {"distance threshold -1"});
  options.distance_thresholds = {INFINITY};
  refused(options, {"distance threshold inf"});
  options = {};
  options.frame_steps = {0};
  refused(options, {"frame step 0"});
  options.frame_steps = {3, 1, 3};
  refused(options, {"frame step 3", "twice"});
  options = {};
  options.score_thresholds = {std::nan("")};
  refused(options, {"score threshold nan"});
}

TEST(RepeatabilityMetrics, RefusesPairsThatDoNotFit) {
  RepeatabilityOptions options = structural(Protocol::kEvolin);
  RepeatabilityMetrics metrics(options);
  const SpatialFrame frame = wallFrame(Protocol::kEvolin, {kLine});
  expectError([&] { metrics.addPair(2, frame, frame); }, {"frame step 2"});
  expectError([&] { metrics.add(1, {}); }, {"0 results", "1 settings"});
  const SpatialFrame paper = wallFrame(Protocol::kPaper, {kLine});
  expectError([&] { metrics.addPair(1, paper, paper); }, {"paper", "evolin"});
  expectError([&] { metrics.addPair(1, frame, paper); }, {"paper", "evolin"});
  options.score_thresholds = {0.5};
  RepeatabilityMetrics filtered(options);
  expectError([&] { filtered.addPair(1, frame, frame); }, {"row 0", "no score"});
  EXPECT_EQ(metrics.pairs(1), 0U);
}

}  // namespace
}  // namespace evolin
