// Localisation error of the N best redetections.
#include "evolin_ros/metrics/best_localization.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/metrics/spatial_support.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::segment;
using test::wallFrame;

BestLocalizationOptions best(std::size_t count) {
  BestLocalizationOptions options;
  options.count = count;
  return options;
}

// Forward 2 and 0; backward 2, 0 and, from the last line to the first one, 60.
const LineSegments kFirst = {segment(30, 10, 50, 30), segment(40, 90, 60, 70)};
const LineSegments kSecond = {segment(31, 10, 51, 30), segment(40, 90, 60, 70),
                              segment(60, 10, 80, 30)};

TEST(BestLocalization, AveragesTheSmallestOfBothDirections) {
  const SpatialFrame first = wallFrame(Protocol::kPaper, kFirst);
  const SpatialFrame second = wallFrame(Protocol::kPaper, kSecond);
  const auto error_of = [&](std::size_t count) {
    return measureBestLocalization(first, second, best(count));
  };
  EXPECT_EQ(error_of(1).mean_distance, 0);
  EXPECT_EQ(error_of(2).mean_distance, 0);
  EXPECT_DOUBLE_EQ(error_of(3).mean_distance, 2.0 / 3);
  EXPECT_EQ(error_of(4).mean_distance, 1);
  EXPECT_EQ(error_of(5).mean_distance, 64.0 / 5);
  EXPECT_EQ(error_of(5).used, 5U);
  EXPECT_EQ(error_of(50).used, 5U);
  EXPECT_EQ(error_of(50).mean_distance, 64.0 / 5);
}

TEST(BestLocalization, TheOrthogonalDistanceIsGatedUnderEvolin) {
  BestLocalizationOptions options = best(9);
  options.distance = LineDistance::kOrthogonal;
  // Beside each other along the same direction: no overlap.
  const LineSegments first = {segment(10, 20, 30, 21)};
  const LineSegments second = {segment(60, 20, 80, 21)};
  EXPECT_EQ(measureBestLocalization(wallFrame(Protocol::kEvolin, first),
                                    wallFrame(Protocol::kEvolin, second), options)
                .used,
            0U);
  EXPECT_EQ(measureBestLocalization(wallFrame(Protocol::kPaper, first),
                                    wallFrame(Protocol::kPaper, second), options)
                .used,
            2U);
}

TEST(BestLocalization, PairsWithoutAnyAreCountedAndLeaveTheMeanAlone) {
  BestLocalization metric(best(4));
  EXPECT_FALSE(metric.error().has_value());
  metric.addPair(wallFrame(Protocol::kPaper, {}), wallFrame(Protocol::kPaper, kSecond));
  EXPECT_FALSE(metric.error().has_value());
  metric.addPair(wallFrame(Protocol::kPaper, kFirst), wallFrame(Protocol::kPaper, kSecond));
  EXPECT_EQ(metric.error(), 1);
  metric.addPair(wallFrame(Protocol::kPaper, kFirst), wallFrame(Protocol::kPaper, kFirst));
  EXPECT_EQ(metric.error(), 0.5);
  EXPECT_EQ(metric.pairs(), 3U);
  EXPECT_EQ(metric.shortPairs(), 1U);
}

TEST(BestLocalization, GrowsWithTheNumber) {
  test::RandomLines random(6);
  const LineSegments world = random.anywhere(30, 127, 127);
  const SpatialFrame first = wallFrame(Protocol::kPaper, random.detectionsOf(world, 40, 4));
  const SpatialFrame second = wallFrame(Protocol::kPaper, random.detectionsOf(world, 40, 4), 3);
  double before = 0;
  for (std::size_t count = 1; count < 60; ++count) {
    const PairBestLocalization pair = measureBestLocalization(first, second, best(count));
    EXPECT_EQ(pair.used, count);
    EXPECT_GE(pair.mean_distance, before);
    before = pair.mean_distance;
  }
  EXPECT_GT(before, 1);
}

TEST(BestLocalization, MergeEqualsAllInOneToTheLastBit) {
  test::RandomLines random(7);
  const LineSegments world = random.anywhere(30, 127, 127);
  std::vector<SpatialFrame> frames;
  frames.reserve(6);
  for (int number = 0; number < 6; ++number) {
    frames.push_back(wallFrame(Protocol::kEvolin, random.detectionsOf(world, 40, 4), number));
  }
  BestLocalization all(best(20));
  BestLocalization odd(best(20));
  BestLocalization even(best(20));
  for (std::size_t number = 1; number < frames.size(); ++number) {
    all.addPair(frames[number - 1], frames[number]);
    (number % 2 == 0 ? even : odd).addPair(frames[number - 1], frames[number]);
  }
  even.merge(odd);
  EXPECT_EQ(even.error(), all.error());
  EXPECT_EQ(even.pairs(), 5U);
  EXPECT_THROW(even.merge(BestLocalization(best(3))), Error);
  even.reset();
  EXPECT_EQ(even.pairs(), 0U);
  EXPECT_FALSE(even.error().has_value());
}

TEST(BestLocalization, RefusesZero) { EXPECT_THROW(BestLocalization(best(0)), Error); }

}  // namespace
}  // namespace evolin
