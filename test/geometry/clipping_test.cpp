// Clamping and clipping of segments.
#include "evolin_ros/geometry/clipping.h"

#include <gtest/gtest.h>

#include <limits>

#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr Rectangle kBox{0, 0, 10, 8};

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  line.score = 0.5;
  line.id = 3;
  return line;
}

void expectEqual(const LineSegment& line, double x1, double y1, double x2, double y2) {
  EXPECT_DOUBLE_EQ(line.x1, x1);
  EXPECT_DOUBLE_EQ(line.y1, y1);
  EXPECT_DOUBLE_EQ(line.x2, x2);
  EXPECT_DOUBLE_EQ(line.y2, y2);
  EXPECT_EQ(line.score, 0.5);
  EXPECT_EQ(line.id, 3);
}

TEST(ClampToRectangle, MovesEachCoordinateOnItsOwn) {
  expectEqual(clampToRectangle(segment(-5, 4, 15, 20), kBox), 0, 4, 10, 8);
}

TEST(ClipToRectangle, CutsWhereTheLineCrossesTheBorder) {
  expectEqual(*clipToRectangle(segment(-5, 2, 15, 6), kBox), 0, 3, 10, 5);
}

TEST(ClipToRectangle, CutsOneEndAlone) {
  expectEqual(*clipToRectangle(segment(5, 5, 5, 20), kBox), 5, 5, 5, 8);
}

TEST(ClipToRectangle, LeavesInsideSegmentsAlone) {
  expectEqual(*clipToRectangle(segment(0, 0, 10, 8), kBox), 0, 0, 10, 8);
}

TEST(ClipToRectangle, FindsNothingOutside) {
  EXPECT_FALSE(clipToRectangle(segment(-5, -1, 20, -1), kBox));
  EXPECT_FALSE(clipToRectangle(segment(-5, 2, 2, -5), kBox));
  EXPECT_FALSE(clipToRectangle(segment(11, 4, 11, 4), kBox));
  EXPECT_FALSE(clipToRectangle(segment(1, std::numeric_limits<double>::infinity(), 2, 2), kBox));
}

TEST(ClipToRectangle, BearsTheLargestNumbers) {
  const double most = std::numeric_limits<double>::max();
  // Through the middle of the box, from one end of all numbers to the other.
  for (const LineSegment& line :
       {segment(-most, 4, most, 4), segment(5, most, 5, -most), segment(-1e308, 4, 1e308, 4),
        segment(-most, -most, most, most), segment(5, 4, most, most)}) {
    const std::optional<LineSegment> part = clipToRectangle(line, kBox);
    ASSERT_TRUE(part.has_value());
    EXPECT_TRUE(part->isFinite());
    for (const auto& [x, y] : {std::pair(part->x1, part->y1), std::pair(part->x2, part->y2)}) {
      EXPECT_TRUE(x >= kBox.left && x <= kBox.right) << x;
      EXPECT_TRUE(y >= kBox.top && y <= kBox.bottom) << y;
    }
  }
  EXPECT_FALSE(clipToRectangle(segment(-most, -1, most, -1), kBox));
  const Rectangle everything{-most, -most, most, most};
  expectEqual(*clipToRectangle(segment(-most, 0.1, most, -0.3), everything), -most, 0.1, most,
              -0.3);
}

TEST(ClipToRectangle, StaysOnTheLineAndInside) {
  test::RandomLines random(3);
  int clipped = 0;
  for (LineSegment line : random.anywhere(500, 30, 24)) {
    line.x1 -= 10;
    line.x2 -= 10;
    line.y1 -= 8;
    line.y2 -= 8;
    const std::optional<LineSegment> part = clipToRectangle(line, kBox);
    if (!part) {
      continue;
    }
    ++clipped;
    for (const auto& [x, y] : {std::pair(part->x1, part->y1), std::pair(part->x2, part->y2)}) {
      EXPECT_GE(x, kBox.left);
      EXPECT_LE(x, kBox.right);
      EXPECT_GE(y, kBox.top);
      EXPECT_LE(y, kBox.bottom);
      const double cross =
          (line.x2 - line.x1) * (y - line.y1) - (line.y2 - line.y1) * (x - line.x1);
      EXPECT_NEAR(cross / line.length(), 0, 1e-9);
    }
    EXPECT_GE((line.x2 - line.x1) * (part->x2 - part->x1), 0);
  }
  EXPECT_GT(clipped, 100);
}

}  // namespace
}  // namespace evolin
