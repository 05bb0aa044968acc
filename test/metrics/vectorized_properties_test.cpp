// Detection on segments as vectors against an exhaustive computation, and what holds for any lines.
#include "evolin_ros/metrics/vectorized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/metrics/vectorized_support.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::countsOf;
using test::expectEqual;
using test::kOrthogonal5;
using test::kSettings;
using test::kStructural5;
using test::kUnit;
using test::optionsOf;
using test::segment;

/// The metric written down once more, without search structures, bits or sums.
Classification exhaustive(const LineSegments& predicted, const LineSegments& truth, bool scored,
                          const VectorizedSetting& setting, Protocol protocol) {
  const bool evolin = protocol == Protocol::kEvolin;
  std::vector<double> distances;
  std::vector<std::size_t> rows;
  for (const LineSegment& line : predicted) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t best_row = 0;
    for (std::size_t row = 0; row < truth.size(); ++row) {
      const double distance = setting.distance == LineDistance::kStructural
                                  ? structuralDistance(line, truth[row])
                                  : orthogonalDistance(line, truth[row], evolin);
      if (distance < best) {
        best = distance;
        best_row = row;
      }
    }
    distances.push_back(best);
    rows.push_back(best_row);
  }
  const auto near = [&](std::size_t i) {
    return evolin ? distances[i] < setting.threshold : distances[i] <= setting.threshold;
  };
  Classification counts{0, predicted.size(), truth.size()};
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    bool right = near(i);
    for (std::size_t j = 0; right && j < predicted.size(); ++j) {
      if (j == i || !near(j) || rows[j] != rows[i]) {
        continue;
      }
      const double better =
          scored ? predicted[j].score - predicted[i].score : distances[i] - distances[j];
      right = !(better > 0 || (better == 0 && j < i));
    }
    counts.true_positives += right ? 1 : 0;
  }
  return counts;
}

class ExhaustiveComparison : public ::testing::TestWithParam<std::tuple<Protocol, bool>> {};

TEST_P(ExhaustiveComparison, AgreesForEverySettingAndScoreThreshold) {
  const auto [protocol, scored] = GetParam();
  test::RandomLines random(21);
  VectorizedMetrics metrics(optionsOf(protocol));
  std::vector<double> thresholds = {-std::numeric_limits<double>::infinity()};
  if (scored) {
    thresholds.insert(thresholds.end(), {-1, 0, 0.25, 0.5, 0.9, 2});
  }
  std::vector<std::vector<Classification>> expected(kSettings,
                                                    std::vector<Classification>(thresholds.size()));
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    LineSegments truth = random.anywhere(30, 100, 100);
    LineSegments predicted = random.detectionsOf(truth, 90, 6);
    for (LineSegment& line : truth) {
      line.x1 += 10;  // all of them inside, so that preparing changes nothing
      line.y1 += 10;
      line.x2 += 10;
      line.y2 += 10;
    }
    for (LineSegment& line : predicted) {
      line.x1 += 10;
      line.y1 += 10;
      line.x2 += 10;
      line.y2 += 10;
    }
    predicted.push_back(predicted[3]);
    truth.push_back(truth[5]);
    metrics.addFrame(frame, "f", kUnit, predicted, truth, scored);
    for (std::size_t setting = 0; setting < kSettings; ++setting) {
      for (std::size_t t = 0; t < thresholds.size(); ++t) {
        LineSegments kept;
        for (const LineSegment& line : predicted) {
          if (t == 0 || line.score > thresholds[t]) {
            kept.push_back(line);
          }
        }
        expected[setting][t] +=
            exhaustive(kept, truth, scored, metrics.settings()[setting], protocol);
      }
    }
  }
  for (std::size_t setting = 0; setting < kSettings; ++setting) {
    EXPECT_GT(expected[setting][0].true_positives, 0U);
    EXPECT_LT(expected[setting][0].true_positives, expected[setting][0].predicted);
    for (std::size_t t = 0; t < thresholds.size(); ++t) {
      expectEqual(metrics.classification(setting, thresholds[t]), expected[setting][t]);
      Classification sum;
      for (const Classification& frame : metrics.frameClassifications(setting, thresholds[t])) {
        sum += frame;
      }
      expectEqual(sum, expected[setting][t]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ProtocolsAndScores, ExhaustiveComparison,
                         ::testing::Combine(::testing::Values(Protocol::kEvolin, Protocol::kPaper),
                                            ::testing::Bool()));

struct RandomFrame {
  LineSegments truth;
  LineSegments predicted;
};

std::vector<RandomFrame> randomFrames(int count) {
  test::RandomLines random(31);
  std::vector<RandomFrame> frames(count);
  for (RandomFrame& frame : frames) {
    frame.truth = random.anywhere(15, 640, 480);
    frame.predicted = random.detectionsOf(frame.truth, 40, 40);
  }
  return frames;
}

VectorizedMetrics measure(const std::vector<RandomFrame>& frames,
                          const std::vector<std::uint32_t>& numbers) {
  VectorizedMetrics metrics;
  for (const std::uint32_t number : numbers) {
    metrics.addFrame(number, "f", {640, 480}, frames[number].predicted, frames[number].truth, true);
  }
  return metrics;
}

void expectSame(const VectorizedMetrics& a, const VectorizedMetrics& b) {
  EXPECT_EQ(a.frames(), b.frames());
  EXPECT_EQ(a.averagePrecisions(), b.averagePrecisions());
  for (std::size_t setting = 0; setting < a.settings().size(); ++setting) {
    expectEqual(a.classification(setting, 0.3), b.classification(setting, 0.3));
    EXPECT_EQ(a.averagePrecision(setting), a.averagePrecisions()[setting]);
    EXPECT_EQ(a.curve(setting).precision, b.curve(setting).precision);
    EXPECT_EQ(a.curve(setting).recall, b.curve(setting).recall);
  }
}

TEST(VectorizedProperties, IsPerfectOnIdenticalLines) {
  test::RandomLines random(41);
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const LineSegments lines = random.anywhere(50, 127, 127);
    for (std::size_t setting = 0; setting < kSettings; ++setting) {
      const Classification counts = countsOf(lines, lines, protocol, setting);
      EXPECT_EQ(counts.precision(), 1);
      EXPECT_EQ(counts.recall(), 1);
      EXPECT_EQ(counts.fScore(), 1);
    }
  }
}

TEST(VectorizedProperties, IsBlindToRowsAndEndpointOrder) {
  test::RandomLines random(42);
  const std::vector<RandomFrame> frames = randomFrames(8);
  for (const RandomFrame& frame : frames) {
    LineSegments predicted = frame.predicted;
    LineSegments truth = frame.truth;
    random.shuffle(&predicted);
    random.shuffle(&truth);
    for (LineSegment& line : predicted) {
      if (random.index(2) == 0) {
        std::swap(line.x1, line.x2);
        std::swap(line.y1, line.y2);
      }
    }
    for (std::size_t setting = 0; setting < kSettings; ++setting) {
      expectEqual(countsOf(predicted, truth, Protocol::kEvolin, setting, {640, 480}),
                  countsOf(frame.predicted, frame.truth, Protocol::kEvolin, setting, {640, 480}));
    }
  }
}

TEST(VectorizedProperties, TheImagesResolutionDoesNotMatter) {
  for (const RandomFrame& frame : randomFrames(4)) {
    const auto twice = [](LineSegments lines) {
      for (LineSegment& line : lines) {
        line = segment(2 * line.x1, 2 * line.y1, 2 * line.x2, 2 * line.y2, line.score);
      }
      return lines;
    };
    for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
      for (std::size_t setting = 0; setting < kSettings; ++setting) {
        expectEqual(
            countsOf(twice(frame.predicted), twice(frame.truth), protocol, setting, {1280, 960}),
            countsOf(frame.predicted, frame.truth, protocol, setting, {640, 480}));
      }
    }
  }
}

TEST(VectorizedProperties, ShiftsWithTheLinesWithinTheImage) {
  test::RandomLines random(43);
  // Far enough from the border that nothing is clamped, on a grid that shifts leave exact.
  const auto middle = [](LineSegments lines, double dx, double dy) {
    const auto place = [](double value) { return 32 + std::round(32 * value) / 64; };
    for (LineSegment& line : lines) {
      line = segment(place(line.x1) + dx, place(line.y1) + dy, place(line.x2) + dx,
                     place(line.y2) + dy, line.score);
    }
    return lines;
  };
  std::uint64_t hits = 0;
  for (int round = 0; round < 5; ++round) {
    const LineSegments truth = random.anywhere(15, 120, 120);
    const LineSegments predicted = random.detectionsOf(truth, 40, 12);
    for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
      for (std::size_t setting = 0; setting < kSettings; ++setting) {
        const Classification here =
            countsOf(middle(predicted, 0, 0), middle(truth, 0, 0), protocol, setting);
        expectEqual(countsOf(middle(predicted, 14, -9), middle(truth, 14, -9), protocol, setting),
                    here);
        hits += here.true_positives;
      }
    }
  }
  EXPECT_GT(hits, 100U) << "too few hits to tell";
}

TEST(VectorizedProperties, NothingIsZeroAndNotNaN) {
  VectorizedMetrics metrics;
  metrics.addFrame(0, "f", kUnit, {}, {}, true);
  for (std::size_t setting = 0; setting < kSettings; ++setting) {
    EXPECT_EQ(metrics.classification(setting).precision(), 0);
    EXPECT_EQ(metrics.classification(setting).recall(), 0);
    EXPECT_EQ(metrics.classification(setting).fScore(), 0);
    EXPECT_FALSE(metrics.averagePrecision(setting).has_value());
  }
}

TEST(VectorizedProperties, GrowsWithTheThreshold) {
  const VectorizedMetrics metrics = measure(randomFrames(8), {0, 1, 2, 3, 4, 5, 6, 7});
  for (const std::size_t first : {kOrthogonal5, kStructural5}) {
    const auto hits = [&](std::size_t k) {
      return metrics.classification(first + k).true_positives;
    };
    EXPECT_LE(hits(0), hits(1));
    EXPECT_LE(hits(1), hits(2));
    EXPECT_LT(hits(0), hits(2));
  }
}

TEST(VectorizedProperties, OrderOfFramesDoesNotMatter) {
  const std::vector<RandomFrame> frames = randomFrames(5);
  expectSame(measure(frames, {0, 1, 2, 3, 4}), measure(frames, {3, 0, 4, 2, 1}));
}

TEST(VectorizedProperties, MergeInAnyOrderEqualsAllInOne) {
  const std::vector<RandomFrame> frames = randomFrames(6);
  const VectorizedMetrics all = measure(frames, {0, 1, 2, 3, 4, 5});
  const std::vector<VectorizedMetrics> parts = {measure(frames, {4, 1}), measure(frames, {5}),
                                                VectorizedMetrics(), measure(frames, {3, 0, 2})};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  do {
    VectorizedMetrics merged;
    for (const std::size_t part : order) {
      merged.merge(parts[part]);
    }
    expectSame(merged, all);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(VectorizedProperties, MergeRefusesWhatDoesNotBelongTogether) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  VectorizedMetrics metrics = measure(frames, {0});
  EXPECT_THROW(metrics.merge(measure(frames, {1, 0})), Error);
  EXPECT_THROW(metrics.merge(metrics), Error);
  EXPECT_THROW(metrics.merge(VectorizedMetrics(optionsOf(Protocol::kPaper))), Error);
  VectorizedMetrics unscored;
  unscored.addFrame(7, "f", kUnit, {segment(1, 1, 2, 2)}, {}, false);
  EXPECT_THROW(metrics.merge(unscored), Error);
  expectSame(metrics, measure(frames, {0}));
}

TEST(VectorizedProperties, ResetKeepsTheOptionsAlone) {
  const std::vector<RandomFrame> frames = randomFrames(2);
  VectorizedMetrics metrics = measure(frames, {0, 1});
  metrics.reset();
  EXPECT_EQ(metrics.frames(), 0U);
  EXPECT_EQ(metrics.settings().size(), kSettings);
  metrics.addFrame(1, "f", {640, 480}, frames[1].predicted, frames[1].truth, true);
  expectSame(metrics, measure(frames, {1}));
}

}  // namespace
}  // namespace evolin
