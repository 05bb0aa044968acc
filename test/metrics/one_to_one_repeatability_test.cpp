// Repeatability by a one-to-one matching with gates.
#include "evolin_ros/metrics/one_to_one_repeatability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/metrics/spatial_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::expectError;
using test::segment;
using test::wallFrame;

OneToOneRepeatability measure(const LineSegments& first, const LineSegments& second,
                              OneToOneOptions options = {}, double pixels_right = 0) {
  OneToOneRepeatability metric(options);
  return metric.addPair(wallFrame(Protocol::kPaper, first),
                        wallFrame(Protocol::kPaper, second, pixels_right));
}

TEST(OneToOneRepeatability, ALineServesOnce) {
  // Two detections of one line: the nearer one is its partner.
  const auto result =
      measure({segment(20, 50, 100, 50)}, {segment(20, 51, 100, 51), segment(20, 50.5, 100, 50.5)});
  EXPECT_EQ(result.visible(), 3U);
  EXPECT_EQ(result.matched(), 2U);  // one a direction
  EXPECT_DOUBLE_EQ(result.byCount(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(result.byLength(), 2.0 / 3);
}

TEST(OneToOneRepeatability, GatesAreInclusive) {
  // One pixel aside: the orthogonal distance of parallel lines is twice that.
  const LineSegments line = {segment(20, 50, 100, 50)};
  const LineSegments aside = {segment(20, 51, 100, 51)};
  OneToOneOptions options;
  options.max_distance = 2;
  EXPECT_EQ(measure(line, aside, options).matched(), 2U);
  options.max_distance = 1.999;
  EXPECT_EQ(measure(line, aside, options).matched(), 0U);
  // Half of each covers the other.
  const LineSegments along = {segment(60, 50, 140 - 13, 50)};
  options.max_distance = 5;
  options.min_overlap = (40.0 / 80 + 40.0 / 67) / 2;
  EXPECT_EQ(measure(line, along, options).matched(), 2U);
  options.min_overlap += 1e-9;
  EXPECT_EQ(measure(line, along, options).matched(), 0U);
}

TEST(OneToOneRepeatability, DirectionsMustAgree) {
  OneToOneOptions options;
  options.max_distance = 1000;
  options.min_overlap = 0;
  const LineSegments line = {segment(20, 50, 100, 50)};
  const auto turned = [](double degrees) {
    const double radians = degrees * M_PI / 180;
    return LineSegments{segment(60 - 30 * std::cos(radians), 50 - 30 * std::sin(radians),
                                60 + 30 * std::cos(radians), 50 + 30 * std::sin(radians))};
  };
  options.max_angle = 10;
  EXPECT_EQ(measure(line, turned(9.9), options).matched(), 2U);
  EXPECT_EQ(measure(line, turned(-9.9), options).matched(), 2U);
  EXPECT_EQ(measure(line, turned(180 - 9.9), options).matched(), 2U);
  EXPECT_EQ(measure(line, turned(10.1), options).matched(), 0U);
  EXPECT_EQ(measure(line, turned(90), options).matched(), 0U);
  options.max_angle = 90;
  EXPECT_EQ(measure(line, turned(90), options).matched(), 2U);
}

TEST(OneToOneRepeatability, LengthIsWhatThePartnerCovers) {
  // 80 and 60 pixels long, 60 of them in common.
  const auto result = measure({segment(20, 50, 100, 50)}, {segment(20, 50, 80, 50)});
  EXPECT_EQ(result.byCount(), 1);
  EXPECT_DOUBLE_EQ(result.byLength(), (60.0 + 60) / (80 + 60));
}

TEST(OneToOneRepeatability, LinesOutOfViewDoNotCount) {
  // Seven pixels to the left, the second line leaves the image.
  const auto result =
      measure({segment(20, 50, 100, 50), segment(1, 10, 5, 20)}, {segment(13, 50, 93, 50)}, {}, 7);
  EXPECT_EQ(result.visible(), 2U);
  EXPECT_EQ(result.byCount(), 1);
  EXPECT_EQ(result.byLength(), 1);
}

TEST(OneToOneRepeatability, PointsHaveNoPartner) {
  OneToOneOptions options;
  options.max_angle = 90;
  options.min_overlap = 0;
  const auto result = measure({segment(20, 50, 100, 50)}, {segment(50, 50, 50, 50)}, options);
  EXPECT_EQ(result.visible(), 1U);
  EXPECT_EQ(result.matched(), 0U);
}

TEST(OneToOneRepeatability, IsPerfectOnIdenticalLinesAndZeroOnNone) {
  test::RandomLines random(9);
  const LineSegments lines = random.anywhere(60, 127, 127);
  const auto same = measure(lines, lines);
  EXPECT_EQ(same.visible(), 120U);
  EXPECT_EQ(same.byCount(), 1);
  EXPECT_NEAR(same.byLength(), 1, 1e-9);
  EXPECT_EQ(measure({}, {}).byCount(), 0);
  EXPECT_EQ(measure({}, {}).byLength(), 0);
}

TEST(OneToOneRepeatability, IsBlindToRowsAndEndpointOrderAndMonotone) {
  test::RandomLines random(10);
  const LineSegments world = random.anywhere(30, 127, 127);
  const LineSegments first = random.detectionsOf(world, 50, 3);
  const LineSegments second = random.detectionsOf(world, 50, 3);
  LineSegments shuffled = second;
  random.shuffle(&shuffled);
  for (LineSegment& line : shuffled) {
    std::swap(line.x1, line.x2);
    std::swap(line.y1, line.y2);
  }
  const auto expected = measure(first, second);
  const auto actual = measure(first, shuffled);
  EXPECT_GT(expected.matched(), 20U);
  EXPECT_LT(expected.matched(), expected.visible());
  EXPECT_EQ(actual.matched(), expected.matched());
  EXPECT_NEAR(actual.byLength(), expected.byLength(), 1e-9);
  OneToOneOptions narrow;
  narrow.max_distance = 0.5;
  EXPECT_LT(measure(first, second, narrow).matched(), expected.matched());
}

TEST(OneToOneRepeatability, MergeEqualsAllInOneToTheLastBit) {
  test::RandomLines random(11);
  const LineSegments world = random.anywhere(30, 127, 127);
  OneToOneRepeatability all;
  OneToOneRepeatability odd;
  OneToOneRepeatability even;
  SpatialFrame before = wallFrame(Protocol::kEvolin, random.detectionsOf(world, 40, 3));
  for (int number = 1; number < 7; ++number) {
    const SpatialFrame frame =
        wallFrame(Protocol::kEvolin, random.detectionsOf(world, 40, 3), number);
    all.addPair(before, frame);
    (number % 2 == 0 ? even : odd).addPair(before, frame);
    before = frame;
  }
  even.merge(odd);
  EXPECT_EQ(even.pairs(), 6U);
  EXPECT_EQ(even.byCount(), all.byCount());
  EXPECT_EQ(even.byLength(), all.byLength());
  EXPECT_GT(all.byLength(), 0);
  even.reset();
  EXPECT_EQ(even.visible(), 0U);
  OneToOneOptions other;
  other.max_angle = 7;
  EXPECT_THROW(even.merge(OneToOneRepeatability(other)), Error);
}

TEST(OneToOneRepeatability, RefusesGatesOutOfRange) {
  const auto refused = [](OneToOneOptions options, const std::string& word) {
    expectError([&options] { OneToOneRepeatability metric(options); }, {word});
  };
  refused({0, 5, 0.5}, "max_distance 0");
  refused({INFINITY, 5, 0.5}, "max_distance inf");
  refused({5, 0, 0.5}, "max_angle 0");
  refused({5, 91, 0.5}, "max_angle 91");
  refused({5, 5, 1.5}, "min_overlap 1.5");
  refused({5, 5, NAN}, "min_overlap nan");
}

}  // namespace
}  // namespace evolin
