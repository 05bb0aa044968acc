// Detection on drawn lines: cases by hand, what must not matter, merging, budgets, refusals.
#include "evolin_ros/metrics/heatmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr ImageSize kSize{640, 480};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LineSegment segment(double x1, double y1, double x2, double y2, double score = kNoScore) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  line.score = score;
  return line;
}

void expectCounts(const Classification& counts, std::uint64_t true_positives,
                  std::uint64_t predicted, std::uint64_t ground_truth) {
  EXPECT_EQ(counts.true_positives, true_positives);
  EXPECT_EQ(counts.predicted, predicted);
  EXPECT_EQ(counts.ground_truth, ground_truth);
}

void expectEqual(const Classification& a, const Classification& b) {
  expectCounts(a, b.true_positives, b.predicted, b.ground_truth);
}

Classification countsOf(const LineSegments& predicted, const LineSegments& truth,
                        ImageSize size = kSize) {
  HeatmapMetrics metrics;
  metrics.addFrame(0, "0000", size, predicted, truth);
  return metrics.classification();
}

struct RandomFrame {
  LineSegments truth;
  LineSegments predicted;
};

std::vector<RandomFrame> randomFrames(int count) {
  test::RandomLines random(31);
  std::vector<RandomFrame> frames(static_cast<std::size_t>(count));
  for (RandomFrame& frame : frames) {
    frame.truth = random.anywhere(8, 200, 150);
    frame.predicted = random.detectionsOf(frame.truth, 20, 10);
  }
  return frames;
}

const std::vector<double> kThresholds = {0.25, 0.75, 0, 0.5};

HeatmapMetrics measure(const std::vector<RandomFrame>& frames,
                       const std::vector<std::uint32_t>& numbers,
                       const std::vector<double>& thresholds = kThresholds) {
  HeatmapOptions options;
  options.score_thresholds = thresholds;
  HeatmapMetrics metrics(options);
  for (const std::uint32_t number : numbers) {
    metrics.addFrame(number, "f", {200, 150}, frames[number].predicted, frames[number].truth);
  }
  return metrics;
}

void expectSame(const HeatmapMetrics& a, const HeatmapMetrics& b) {
  EXPECT_EQ(a.frames(), b.frames());
  EXPECT_EQ(a.scoreThresholds(), b.scoreThresholds());
  ASSERT_EQ(a.settings(), b.settings());
  EXPECT_EQ(a.summary().average_precision, b.summary().average_precision);
  EXPECT_EQ(a.summary().max_f_score, b.summary().max_f_score);
  EXPECT_EQ(a.curve().recall, b.curve().recall);
  EXPECT_EQ(a.curve().precision, b.curve().precision);
  for (std::size_t setting = 0; setting < a.settings(); ++setting) {
    expectEqual(a.classification(setting), b.classification(setting));
    const auto of_a = a.frameClassifications(setting);
    const auto of_b = b.frameClassifications(setting);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t frame = 0; frame < of_a.size(); ++frame) {
      expectEqual(of_a[frame], of_b[frame]);
    }
  }
}

TEST(Heatmap, CountsPixelsOfOneLine) {
  const LineSegments truth = {segment(100, 100, 199, 100)};
  expectCounts(countsOf({segment(100, 104, 199, 104)}, truth), 100, 100, 100);
  expectCounts(countsOf({segment(100, 108, 199, 108)}, truth), 100, 100, 100);
  expectCounts(countsOf({segment(100, 109, 199, 109)}, truth), 0, 100, 100);
  // Half of the line, on top: the pixels up to 8 beyond its end can be reached, but it has no more.
  expectCounts(countsOf({segment(100, 100, 149, 100)}, truth), 50, 50, 100);
  // Twice the line: each pixel matches once.
  expectCounts(countsOf({segment(100, 100, 199, 100), segment(100, 102, 199, 102)}, truth), 100,
               200, 100);
}

TEST(Heatmap, DrawsAPixelOnceHoweverManyLinesCrossIt) {
  const LineSegment a = segment(0, 50, 99, 50);
  const LineSegment b = segment(50, 0, 50, 99);
  expectCounts(countsOf({a, b, a}, {a, b, b}), 199, 199, 199);
}

TEST(Heatmap, DropsNoLine) {
  // Without length, horizontal and vertical: all count.
  expectCounts(countsOf({segment(5, 5, 5, 5)}, {segment(5.5, 5.5, 5.5, 5.5)}), 1, 1, 1);
  expectCounts(countsOf({segment(0, 7, 9, 7), segment(300, 0, 300, 9)}, {}), 0, 20, 0);
}

TEST(Heatmap, ClampsLinesToTheImage) {
  expectCounts(countsOf({segment(-20, -20, -5, -9)}, {segment(0, 0, 3, 0)}), 1, 1, 4);
  expectCounts(countsOf({segment(600, 479, 5000, 479)}, {segment(600, 479, 639, 900)}), 40, 40, 40);
}

TEST(Heatmap, EmptyFramesCount) {
  HeatmapMetrics metrics;
  metrics.addFrame(0, "0000", kSize, {}, {});
  expectCounts(metrics.classification(), 0, 0, 0);
  EXPECT_EQ(metrics.classification().fScore(), 0);
  metrics.addFrame(1, "0001", kSize, {}, {segment(0, 0, 9, 0)});
  metrics.addFrame(2, "0002", kSize, {segment(0, 0, 4, 0)}, {});
  expectCounts(metrics.classification(), 0, 5, 10);
  EXPECT_EQ(metrics.frames(), 3U);
}

TEST(Heatmap, ScoresMustExceedTheThreshold) {
  const LineSegments truth = {segment(0, 0, 9, 0), segment(0, 100, 9, 100)};
  const LineSegments predicted = {segment(0, 0, 9, 0, 0.5), segment(0, 200, 9, 200, 0.7),
                                  segment(0, 100, 9, 100, 0.1)};
  HeatmapMetrics metrics(HeatmapOptions{{0.5, 0.1, 0.7, 0.05}});
  metrics.addFrame(0, "f", kSize, predicted, truth);
  EXPECT_EQ(metrics.scoreThresholds(), (std::vector<double>{0.7, 0.5, 0.1, 0.05}));
  expectCounts(metrics.classification(0), 0, 0, 20);
  expectCounts(metrics.classification(1), 0, 10, 20);
  expectCounts(metrics.classification(2), 10, 20, 20);
  expectCounts(metrics.classification(3), 20, 30, 20);
}

TEST(Heatmap, AveragePrecisionIsTheTrapezoidOverThePointsAlone) {
  // (recall, precision): (0.25, 1), (0.5, 0.5), (0.75, 0.5).
  const std::vector<Classification> counts = {{1, 1, 4}, {2, 4, 4}, {3, 6, 4}};
  EXPECT_EQ(heatmapCurve(counts).recall, (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_EQ(heatmapCurve(counts).precision, (std::vector<double>{1, 0.5, 0.5}));
  const HeatmapSummary summary = summarizeHeatmap(counts);
  EXPECT_DOUBLE_EQ(summary.average_precision, 0.25 * 0.75 + 0.25 * 0.5);
  EXPECT_DOUBLE_EQ(summary.max_f_score, 0.6);
  EXPECT_EQ(summarizeHeatmap({}).average_precision, 0);
  EXPECT_EQ(summarizeHeatmap({{1, 1, 1}}).average_precision, 0);
  EXPECT_EQ(summarizeHeatmap({{1, 1, 1}}).max_f_score, 1);
}

TEST(Heatmap, WithoutThresholdsThereIsNoCurve) {
  const HeatmapMetrics metrics = measure(randomFrames(2), {0, 1}, {});
  EXPECT_EQ(metrics.settings(), 1U);
  EXPECT_TRUE(metrics.scoreThresholds().empty());
  EXPECT_TRUE(metrics.curve().recall.empty());
  EXPECT_EQ(metrics.summary().max_f_score, 0);
  EXPECT_GT(metrics.classification().true_positives, 0U);
}

TEST(HeatmapProperties, IsPerfectOnIdenticalLines) {
  test::RandomLines random(41);
  const LineSegments lines = random.anywhere(60, kSize.width, kSize.height);
  const Classification counts = countsOf(lines, lines);
  EXPECT_EQ(counts.precision(), 1);
  EXPECT_EQ(counts.recall(), 1);
  EXPECT_EQ(counts.fScore(), 1);
}

TEST(HeatmapProperties, IsBlindToRowsAndToEndpointOrderWhereNoHalfIsInTheWay) {
  test::RandomLines random(42);
  for (const RandomFrame& frame : randomFrames(8)) {
    LineSegments predicted = frame.predicted;
    LineSegments truth = frame.truth;
    random.shuffle(&predicted);
    random.shuffle(&truth);
    for (LineSegment& line : predicted) {
      const int steps = std::max(std::abs(static_cast<int>(line.x2) - static_cast<int>(line.x1)),
                                 std::abs(static_cast<int>(line.y2) - static_cast<int>(line.y1)));
      const bool inside = std::min({line.x1, line.y1, line.x2, line.y2}) >= 0 &&
                          std::max(line.x1, line.x2) < 200 && std::max(line.y1, line.y2) < 150;
      if (steps % 2 == 1 && inside) {
        std::swap(line.x1, line.x2);
        std::swap(line.y1, line.y2);
      }
    }
    expectEqual(countsOf(predicted, truth, {200, 150}),
                countsOf(frame.predicted, frame.truth, {200, 150}));
  }
}

TEST(HeatmapProperties, ShiftsWithTheImage) {
  for (const RandomFrame& frame : randomFrames(4)) {
    LineSegments predicted = frame.predicted;
    LineSegments truth = frame.truth;
    for (LineSegments* lines : {&predicted, &truth}) {
      for (LineSegment& line : *lines) {  // whole numbers: 200 halves exactly
        for (double* value : {&line.x1, &line.y1, &line.x2, &line.y2}) {
          *value = std::floor(std::clamp(*value, 0.0, 199.0));
        }
        line.x2 = line.x1 < 100 ? line.x1 + 64 : line.x1 - 64;
        line.y2 = std::clamp(line.y2, line.y1 - 60, line.y1 + 60);
      }
    }
    const Classification before = countsOf(predicted, truth);
    for (LineSegments* lines : {&predicted, &truth}) {
      for (LineSegment& line : *lines) {
        line.x1 += 300;
        line.x2 += 300;
        line.y1 += 200;
        line.y2 += 200;
      }
    }
    expectEqual(countsOf(predicted, truth), before);
  }
}

TEST(HeatmapProperties, EachThresholdEqualsItsOwnRun) {
  const std::vector<RandomFrame> frames = randomFrames(6);
  const HeatmapMetrics metrics = measure(frames, {0, 1, 2, 3, 4, 5});
  for (std::size_t setting = 0; setting < metrics.settings(); ++setting) {
    std::vector<RandomFrame> kept = frames;
    for (RandomFrame& frame : kept) {
      LineSegments above;
      for (const LineSegment& line : frame.predicted) {
        if (line.score > metrics.scoreThresholds()[setting]) {
          above.push_back(line);
        }
      }
      frame.predicted = above;
    }
    expectEqual(metrics.classification(setting),
                measure(kept, {0, 1, 2, 3, 4, 5}, {}).classification());
  }
}

TEST(HeatmapProperties, LowerThresholdsNeverMatchOrPredictLess) {
  const HeatmapMetrics metrics = measure(randomFrames(6), {0, 1, 2, 3, 4, 5});
  for (std::size_t setting = 1; setting < metrics.settings(); ++setting) {
    const Classification& high = metrics.classification(setting - 1);
    const Classification& low = metrics.classification(setting);
    EXPECT_GT(low.true_positives, high.true_positives);
    EXPECT_GT(low.predicted, high.predicted);
    EXPECT_EQ(low.ground_truth, high.ground_truth);
    EXPECT_LE(low.true_positives, std::min(low.predicted, low.ground_truth));
  }
}

TEST(HeatmapProperties, OrderOfFramesDoesNotMatter) {
  const std::vector<RandomFrame> frames = randomFrames(5);
  expectSame(measure(frames, {0, 1, 2, 3, 4}), measure(frames, {3, 0, 4, 2, 1}));
}

TEST(HeatmapProperties, FramesAddUp) {
  const HeatmapMetrics metrics = measure(randomFrames(5), {4, 1, 0, 3, 2});
  for (std::size_t setting = 0; setting < metrics.settings(); ++setting) {
    Classification sum;
    for (const Classification& frame : metrics.frameClassifications(setting)) {
      sum += frame;
    }
    expectEqual(metrics.classification(setting), sum);
  }
}

TEST(HeatmapProperties, MergeInAnyOrderEqualsAllInOne) {
  const std::vector<RandomFrame> frames = randomFrames(6);
  const HeatmapMetrics all = measure(frames, {0, 1, 2, 3, 4, 5});
  const HeatmapMetrics empty = measure(frames, {});
  const std::vector<HeatmapMetrics> parts = {measure(frames, {4, 1}), measure(frames, {5}), empty,
                                             measure(frames, {3, 0, 2})};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  do {
    HeatmapMetrics merged = empty;
    for (const std::size_t part : order) {
      merged.merge(parts[part]);
    }
    expectSame(merged, all);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(HeatmapProperties, MergeRefusesWhatDoesNotBelongTogether) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  HeatmapMetrics metrics = measure(frames, {0});
  test::expectError([&] { metrics.merge(measure(frames, {1, 0})); }, {"frame number 0", "both"});
  test::expectError([&] { metrics.merge(metrics); }, {"frame number 0"});
  test::expectError([&] { metrics.merge(measure(frames, {1}, {0.5})); }, {"score thresholds"});
  expectSame(metrics, measure(frames, {0}));
}

TEST(HeatmapProperties, ResetKeepsTheOptionsAlone) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  HeatmapMetrics metrics = measure(frames, {0, 1});
  metrics.reset();
  expectSame(metrics, measure(frames, {}));
  metrics.addFrame(1, "f", {200, 150}, frames[1].predicted, frames[1].truth);
  expectSame(metrics, measure(frames, {1}));
}

TEST(HeatmapBudget, AFrameThatDoesNotFitIsRefusedAndChangesNothing) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  HeatmapOptions options;
  options.score_thresholds = kThresholds;
  options.frame_budget = 1e-9;  // gone before the first pixel is matched
  HeatmapMetrics hurried(options);
  EXPECT_EQ(hurried.addFrame(0, "f", {200, 150}, frames[0].predicted, frames[0].truth),
            HeatmapOutcome::kOverBudget);
  expectSame(hurried, measure(frames, {}));
  // The number is still free, and what others measured can be merged.
  hurried.merge(measure(frames, {0, 1}));
  expectSame(hurried, measure(frames, {0, 1}));
}

TEST(HeatmapStop, AFrameIsBrokenOffAndChangesNothing) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  std::atomic<bool> stop{true};
  HeatmapOptions options;
  options.score_thresholds = kThresholds;
  options.stop = &stop;
  HeatmapMetrics metrics(options);
  EXPECT_EQ(metrics.addFrame(0, "f", {200, 150}, frames[0].predicted, frames[0].truth),
            HeatmapOutcome::kStopped);
  expectSame(metrics, measure(frames, {}));
  stop = false;
  EXPECT_EQ(metrics.addFrame(0, "f", {200, 150}, frames[0].predicted, frames[0].truth),
            HeatmapOutcome::kAdded);
  expectSame(metrics, measure(frames, {0}));
}

TEST(HeatmapBudget, AFrameThatFitsIsMeasuredAsWithoutBudget) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  HeatmapOptions options;
  options.score_thresholds = kThresholds;
  options.frame_budget = 3600;
  HeatmapMetrics metrics(options);
  for (const std::uint32_t number : {0U, 1U}) {
    EXPECT_EQ(
        metrics.addFrame(number, "f", {200, 150}, frames[number].predicted, frames[number].truth),
        HeatmapOutcome::kAdded);
  }
  expectSame(metrics, measure(frames, {0, 1}));
}

TEST(HeatmapBudget, WrongInputIsAnErrorHoweverSmallTheBudget) {
  HeatmapOptions options;
  options.frame_budget = 1e-9;
  HeatmapMetrics metrics(options);
  test::expectError<GroundTruthError>(
      [&] { metrics.addFrame(0, "f", kSize, {}, {segment(0, kNan, 1, 1)}); }, {"not finite"});
}

TEST(HeatmapBudget, MustBePositive) {
  for (const double budget : {0.0, -1.0, kNan}) {
    HeatmapOptions options;
    options.frame_budget = budget;
    test::expectError([&] { HeatmapMetrics metrics(options); }, {"budget of a frame", "positive"});
  }
}

TEST(HeatmapErrors, NameFrameRowAndValueAndAddNothing) {
  const LineSegment good = segment(0, 0, 9, 0, 0.5);
  HeatmapMetrics metrics(HeatmapOptions{{0.1}});
  metrics.addFrame(7, "0007", kSize, {good}, {good});
  const auto add = [&](std::uint32_t number, ImageSize size, const LineSegments& predicted,
                       const LineSegments& truth) {
    return [=, &metrics] { metrics.addFrame(number, "0008", size, predicted, truth); };
  };
  test::expectError<GroundTruthError>(add(8, kSize, {good}, {good, segment(1, kNan, 3, 4)}),
                                      {"0008", "1,nan,3,4 is not finite"});
  const double infinity = std::numeric_limits<double>::infinity();
  test::expectError(add(8, kSize, {good, good, segment(1, 2, infinity, 4, 0.3)}, {good}),
                    {"frame 0008, row 2", "not finite"});
  test::expectError(add(8, kSize, {segment(1, 2, 3, 4)}, {good}),
                    {"frame 0008, row 0", "no score"});
  test::expectError(add(8, {0, 480}, {good}, {good}), {"0008", "0 x 480"});
  test::expectError(add(8, {30000, 10}, {good}, {good}), {"0008", "25500"});
  test::expectError(add(7, kSize, {good}, {good}), {"number 7", "taken"});
  EXPECT_EQ(metrics.frames(), 1U);
  expectCounts(metrics.classification(), 10, 10, 10);
}

TEST(HeatmapErrors, AThresholdMustBeANumber) {
  test::expectError([] { HeatmapMetrics metrics(HeatmapOptions{{0.5, kNan}}); }, {"nan"});
}

TEST(HeatmapErrors, ScoresMayBeMissingWithoutThresholds) {
  expectCounts(countsOf({segment(0, 0, 9, 0)}, {segment(0, 0, 9, 0, 0.2)}), 10, 10, 10);
}

}  // namespace
}  // namespace evolin
