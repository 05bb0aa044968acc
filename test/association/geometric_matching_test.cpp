// Two segments lie to each other in one way, whatever their order; the best pairs win.
#include "evolin_ros/association/geometric_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/association/textured_images.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::reversed;
using test::segment;

std::vector<std::optional<LineSegment>> expect(const LineSegments& lines) {
  return {lines.begin(), lines.end()};
}

TEST(Relate, GivesAngleDistanceAndOverlap) {
  const auto relation = relate(segment(0, 0, 10, 0), segment(4, 3, 24, 3));
  ASSERT_TRUE(relation);
  EXPECT_DOUBLE_EQ(relation->angle, 0);
  EXPECT_DOUBLE_EQ(relation->distance, 3);
  EXPECT_DOUBLE_EQ(relation->overlap, 0.6);
}

TEST(Relate, OfSlantedSegments) {
  const auto relation = relate(segment(0, 0, 10, 0), segment(0, 0, 3, 3));
  ASSERT_TRUE(relation);
  EXPECT_NEAR(relation->angle, 45, 1e-12);
  // Of (0,0) 0 and (3,3) 3 to the x axis; of (0,0) 0 and (10,0) 10 sin 45 to the diagonal.
  EXPECT_NEAR(relation->distance, (3 + 10 * std::sqrt(0.5)) / 4, 1e-12);
  // 3 of the long one's pixels; 4.24 of the short one.
  EXPECT_NEAR(relation->overlap, 3 / std::hypot(3, 3), 1e-12);
}

TEST(Relate, IsTheSameForAnyOrder) {
  const LineSegment a = segment(12.3, 40.1, 77.7, 52.9);
  const LineSegment b = segment(70.2, 55.5, 20.4, 41.8);
  const auto relation = relate(a, b);
  ASSERT_TRUE(relation);
  for (const LineSegment& x : {a, reversed(a)}) {
    for (const LineSegment& y : {b, reversed(b)}) {
      for (const auto& other : {relate(x, y), relate(y, x)}) {
        ASSERT_TRUE(other);
        EXPECT_NEAR(other->angle, relation->angle, 1e-12);
        EXPECT_NEAR(other->distance, relation->distance, 1e-12);
        EXPECT_NEAR(other->overlap, relation->overlap, 1e-12);
      }
    }
  }
}

TEST(Relate, NothingHasARelationToAPoint) {
  const LineSegment point = segment(5, 5, 5, 5);
  LineSegment infinite = segment(0, 0, 1, 1);
  infinite.x2 = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(relate(point, segment(0, 0, 1, 1)));
  EXPECT_FALSE(relate(segment(0, 0, 1, 1), point));
  EXPECT_FALSE(relate(infinite, segment(0, 0, 1, 1)));
}

TEST(MatchGeometrically, TheBestPairWinsAndTheOtherTakesWhatIsLeft) {
  const LineSegments expected = {segment(0, 0, 100, 0), segment(0, 3, 100, 3)};
  const LineSegments second = {segment(0, 2, 100, 2), segment(0, 8, 100, 8)};
  const LineMatches matches = matchGeometrically(expect(expected), second, {});
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].first, 0U);
  EXPECT_EQ(matches[0].second, 1U);  // 8 px: its nearest is nearer to line 1
  EXPECT_FLOAT_EQ(matches[0].distance, 8);
  EXPECT_EQ(matches[1].first, 1U);
  EXPECT_EQ(matches[1].second, 0U);
  EXPECT_FLOAT_EQ(matches[1].distance, 1);
}

TEST(MatchGeometrically, EachGateKeepsOut) {
  const LineSegment line = segment(0, 0, 100, 0);
  const LineSegment turned = segment(0, 0, 100, 20);
  const LineSegment beside = segment(0, 10.5, 100, 10.5);
  const LineSegment behind = segment(80, 0, 180, 0);
  for (const LineSegment& other : {turned, beside, behind}) {
    EXPECT_TRUE(matchGeometrically(expect({line}), {other}, {}).empty());
  }
  GeometricGates wide;
  wide.max_angle = 12;
  wide.max_distance = 11;
  wide.min_overlap = 0.2;
  for (const LineSegment& other : {turned, beside, behind}) {
    EXPECT_EQ(matchGeometrically(expect({line}), {other}, wide).size(), 1U);
  }
}

TEST(MatchGeometrically, LinesThatAreNotExpectedHaveNoMatch) {
  const LineSegments second = {segment(0, 0, 100, 0)};
  EXPECT_TRUE(matchGeometrically({std::nullopt}, second, {}).empty());
  EXPECT_TRUE(matchGeometrically({}, second, {}).empty());
  EXPECT_TRUE(matchGeometrically(expect(second), {}, {}).empty());
}

TEST(MatchGeometrically, GatesOfZeroTakeWhatIsEqual) {
  GeometricGates none;
  none.max_angle = 0;
  none.max_distance = 0;
  none.min_overlap = 1;
  const LineSegments lines = {segment(0, 0, 100, 0), segment(0, 50, 100, 50)};
  EXPECT_EQ(matchGeometrically(expect(lines), lines, none).size(), 2U);
}

TEST(ReadGates, RefusesWhatIsOutOfRange) {
  GeometricGates gates;
  ParameterReader reader(YAML::Load("{min_overlap: 1.5}"), "associator test");
  test::expectError<ConfigError>([&] { readGates(&reader, &gates); }, {"min_overlap", "1.5"});
}

}  // namespace
}  // namespace evolin
