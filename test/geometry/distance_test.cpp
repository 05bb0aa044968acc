// Distances between segments: by hand, then what must hold for all of them.
#include "evolin_ros/geometry/distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

LineSegment swapped(const LineSegment& line) { return segment(line.x2, line.y2, line.x1, line.y1); }

TEST(LineDistanceNames, AreTheArticles) {
  EXPECT_EQ(toString(LineDistance::kOrthogonal), "orthogonal");
  EXPECT_EQ(toString(LineDistance::kStructural), "structural");
}

TEST(StructuralDistance, AddsBothEndpoints) {
  EXPECT_DOUBLE_EQ(structuralDistance(segment(0, 0, 10, 0), segment(3, 4, 10, 2)), 7);
}

TEST(StructuralDistance, TakesTheBetterPairing) {
  EXPECT_DOUBLE_EQ(structuralDistance(segment(0, 0, 10, 0), segment(10, 1, 0, 1)), 2);
}

TEST(StructuralDistance, OfPointsIsTwiceTheirDistance) {
  EXPECT_DOUBLE_EQ(structuralDistance(segment(1, 1, 1, 1), segment(4, 5, 4, 5)), 10);
}

TEST(OrthogonalDistance, IsTheMeanOfBothDirections) {
  // Endpoints of the second are 1 and 3 from the first's line; those of the first lie 1/sqrt(1.04)
  // and 3/sqrt(1.04) from the second's.
  const double expected = (4 + 4 / std::sqrt(1.04)) / 2;
  EXPECT_NEAR(orthogonalDistance(segment(0, 0, 10, 0), segment(0, 1, 10, 3), true), expected,
              1e-12);
}

TEST(OrthogonalDistance, OfOneLineWithItselfIsZero) {
  EXPECT_EQ(orthogonalDistance(segment(1, 2, 7, 5), segment(1, 2, 7, 5), true), 0);
}

TEST(OrthogonalDistance, PassesExactlyHalfOverlap) {
  // Each covers half of the other.
  EXPECT_DOUBLE_EQ(orthogonalDistance(segment(0, 0, 4, 0), segment(2, 1, 6, 1), true), 2);
}

TEST(OrthogonalDistance, IsInfiniteBelowHalfOverlap) {
  EXPECT_EQ(orthogonalDistance(segment(0, 0, 4, 0), segment(2.0001, 1, 6, 1), true), kInfinity);
}

TEST(OrthogonalDistance, GateTakesTheMeanOfBothOverlaps) {
  // The short one is covered whole, the long one by a tenth: 0.55 on the mean.
  EXPECT_DOUBLE_EQ(orthogonalDistance(segment(0, 0, 10, 0), segment(4, 1, 5, 1), true), 2);
  // By 1/32 of the long one and 0.9375 of the short: 0.484 on the mean.
  EXPECT_EQ(orthogonalDistance(segment(0, 0, 30, 0), segment(-0.0625, 1, 0.9375, 1), true),
            kInfinity);
}

TEST(OrthogonalDistance, SegmentsThatOnlyTouchDoNotOverlap) {
  EXPECT_EQ(orthogonalDistance(segment(0, 0, 4, 0), segment(4, 0, 8, 0), true), kInfinity);
}

TEST(OrthogonalDistance, HasNoGateByTheArticle) {
  EXPECT_DOUBLE_EQ(orthogonalDistance(segment(0, 0, 4, 0), segment(100, 1, 104, 1), false), 2);
}

TEST(OrthogonalDistance, IsInfiniteForASegmentWithoutLength) {
  for (const bool gate : {false, true}) {
    EXPECT_EQ(orthogonalDistance(segment(1, 1, 1, 1), segment(0, 0, 4, 0), gate), kInfinity);
    EXPECT_EQ(orthogonalDistance(segment(0, 0, 4, 0), segment(1, 1, 1, 1), gate), kInfinity);
  }
}

TEST(Distances, AreSymmetricAndBlindToTheOrderOfEndpoints) {
  test::RandomLines random(1);
  const LineSegments first = random.anywhere(200, 20, 20);
  const LineSegments second = random.anywhere(200, 20, 20);
  int finite = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const LineSegment& a = first[i];
    const LineSegment& b = second[i];
    const double structural = structuralDistance(a, b);
    EXPECT_DOUBLE_EQ(structural, structuralDistance(b, a));
    EXPECT_DOUBLE_EQ(structural, structuralDistance(swapped(a), b));
    const double orthogonal = orthogonalDistance(a, b, true);
    if (std::isinf(orthogonal)) {
      EXPECT_TRUE(std::isinf(orthogonalDistance(b, a, true)));
      continue;
    }
    ++finite;
    EXPECT_NEAR(orthogonal, orthogonalDistance(b, a, true), 1e-9);
    EXPECT_NEAR(orthogonal, orthogonalDistance(a, swapped(b), true), 1e-9);
    EXPECT_EQ(orthogonal, orthogonalDistance(a, b, false));
  }
  EXPECT_GT(finite, 20);
}

TEST(CoveredShare, IsThePartUnderTheOthersProjection) {
  const LineSegment line = segment(0, 0, 10, 0);
  EXPECT_DOUBLE_EQ(coveredShare(line, segment(2, 7, 6, -3)), 0.4);
  EXPECT_DOUBLE_EQ(coveredShare(line, segment(6, -3, 2, 7)), 0.4);
  EXPECT_DOUBLE_EQ(coveredShare(line, segment(-5, 1, 3, 1)), 0.3);
  EXPECT_EQ(coveredShare(line, segment(-5, 1, 30, 1)), 1);
  EXPECT_EQ(coveredShare(line, segment(11, 1, 30, 1)), 0);
  EXPECT_EQ(coveredShare(line, segment(4, 1, 4, 9)), 0);
  EXPECT_EQ(coveredShare(segment(4, 4, 4, 4), line), 0);
}

}  // namespace
}  // namespace evolin
