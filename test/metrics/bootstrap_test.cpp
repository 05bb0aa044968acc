// Block bootstrap: what every resample is made of, and the intervals.
#include "evolin_ros/metrics/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "evolin_ros/base/error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

/// The mean of `values` over the resampled frames.
WeightedFigures meanOf(const std::vector<double>& values) {
  return [values](const std::vector<std::uint32_t>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum += weights[i] * values[i];
    }
    return std::vector<double>{sum / static_cast<double>(values.size())};
  };
}

TEST(BlockBootstrap, EveryResampleHasAsManyFramesAsTheSequence) {
  for (const int block : {0, 1, 3, 7}) {
    BootstrapOptions options;
    options.block_length = block;
    options.resamples = 50;
    int calls = 0;
    blockBootstrap(7, options, [&calls](const std::vector<std::uint32_t>& weights) {
      ++calls;
      EXPECT_EQ(weights.size(), 7U);
      EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0U), 7U);
      return std::vector<double>{0};
    });
    EXPECT_EQ(calls, 50);
  }
}

TEST(BlockBootstrap, ABlockOfTheWholeSequenceChangesNothing) {
  BootstrapOptions options;
  options.block_length = 4;
  const auto intervals = blockBootstrap(4, options, meanOf({1, 2, 3, 6}));
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_DOUBLE_EQ(intervals[0].low, 3);
  EXPECT_DOUBLE_EQ(intervals[0].high, 3);
  EXPECT_DOUBLE_EQ(intervals[0].level, 0.95);
}

TEST(BlockBootstrap, BlocksWrapAroundTheEnd) {
  // Blocks of 2 of 4 frames: every frame is drawn as often as any other.
  BootstrapOptions options;
  options.block_length = 2;
  options.resamples = 4000;
  std::vector<double> drawn(4, 0);
  blockBootstrap(4, options, [&drawn](const std::vector<std::uint32_t>& weights) {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      drawn[i] += weights[i];
    }
    return std::vector<double>{0};
  });
  for (const double count : drawn) {
    EXPECT_NEAR(count / 4000, 1, 0.06);
  }
}

TEST(BlockBootstrap, IsTheSameForTheSameSeedAndAnotherForAnother) {
  BootstrapOptions options;
  const auto first = blockBootstrap(
      20, options, meanOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 3, 1, 4, 1, 5, 9, 2, 6, 5, 3}));
  const auto again = blockBootstrap(
      20, options, meanOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 3, 1, 4, 1, 5, 9, 2, 6, 5, 3}));
  EXPECT_EQ(first[0].low, again[0].low);
  EXPECT_EQ(first[0].high, again[0].high);
  options.seed = 2;
  const auto other = blockBootstrap(
      20, options, meanOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 3, 1, 4, 1, 5, 9, 2, 6, 5, 3}));
  EXPECT_TRUE(first[0].low != other[0].low || first[0].high != other[0].high);
}

TEST(BlockBootstrap, OfIndependentFramesIsTheTextbookInterval) {
  // The mean of n values of deviation s has an interval of about +-1.96 s / sqrt(n).
  test::RandomLines random(5);
  std::vector<double> values(400);
  double mean = 0;
  for (double& value : values) {
    value = random.uniform(0, 1);
    mean += value / 400;
  }
  BootstrapOptions options;
  options.block_length = 1;
  options.resamples = 4000;
  const ConfidenceInterval interval = blockBootstrap(400, options, meanOf(values))[0];
  const double half = 1.96 * std::sqrt(1.0 / 12) / 20;
  EXPECT_NEAR(interval.low, mean - half, 0.2 * half);
  EXPECT_NEAR(interval.high, mean + half, 0.2 * half);
}

TEST(BlockBootstrap, LongerBlocksWidenTheIntervalOfSlowlyChangingFrames) {
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = i < 50 ? 0 : 1;
  }
  BootstrapOptions options;
  options.block_length = 1;
  const ConfidenceInterval narrow = blockBootstrap(100, options, meanOf(values))[0];
  options.block_length = 20;
  const ConfidenceInterval wide = blockBootstrap(100, options, meanOf(values))[0];
  EXPECT_GT(wide.high - wide.low, 2 * (narrow.high - narrow.low));
}

TEST(BlockBootstrap, PercentilesLieBetweenNeighboursOfTheSortedFigures) {
  test::RandomLines random(6);
  for (const int count : {1, 2, 40, 1000}) {
    for (const double level : {0.02, 0.5, 0.95, 0.9999}) {
      BootstrapOptions options;
      options.resamples = count;
      options.level = level;
      std::vector<double> figures;
      const auto intervals =
          blockBootstrap(3, options, [&](const std::vector<std::uint32_t>& /*weights*/) {
            figures.push_back(random.uniform(0, 1));
            return std::vector<double>{figures.back()};
          });
      std::sort(figures.begin(), figures.end());
      const auto percentile = [&figures](double fraction) {
        const double position = fraction * static_cast<double>(figures.size() - 1);
        const auto below = static_cast<std::size_t>(position);
        const double next = figures[std::min(below + 1, figures.size() - 1)];
        return figures[below] + (position - std::floor(position)) * (next - figures[below]);
      };
      EXPECT_DOUBLE_EQ(intervals[0].low, percentile((1 - level) / 2)) << count << ", " << level;
      EXPECT_DOUBLE_EQ(intervals[0].high, percentile(1 - (1 - level) / 2))
          << count << ", " << level;
    }
  }
}

TEST(BlockBootstrap, UndefinedResamplesDoNotCount) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bool defined = false;
  const auto intervals = blockBootstrap(5, {}, [&](const std::vector<std::uint32_t>& /*weights*/) {
    defined = !defined;
    return std::vector<double>{defined ? 0.25 : nan, nan};
  });
  EXPECT_DOUBLE_EQ(intervals[0].low, 0.25);
  EXPECT_DOUBLE_EQ(intervals[0].high, 0.25);
  EXPECT_TRUE(std::isnan(intervals[1].low));
  EXPECT_TRUE(std::isnan(intervals[1].high));
}

TEST(BlockBootstrap, RefusesOptionsOutOfRange) {
  const WeightedFigures figures = meanOf({1, 2});
  EXPECT_THROW(blockBootstrap(0, {}, figures), Error);
  BootstrapOptions options;
  options.resamples = 0;
  EXPECT_THROW(blockBootstrap(2, options, figures), Error);
  options = {};
  options.block_length = 3;
  EXPECT_THROW(blockBootstrap(2, options, figures), Error);
  options = {};
  options.level = 1;
  EXPECT_THROW(blockBootstrap(2, options, figures), Error);
}

}  // namespace
}  // namespace evolin
