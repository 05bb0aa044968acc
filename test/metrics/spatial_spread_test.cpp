// Share of grid cells that lines touch.
#include "evolin_ros/metrics/spatial_spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/metrics/vectorized_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::segment;

// Cells of 10 x 10 pixels: the first reaches from -0.5 to 9.5.
constexpr ImageSize kSize{80, 60};

TEST(TouchedCells, CountsEachCellOnce) {
  EXPECT_EQ(touchedCells("f", kSize, {}), 0U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(1, 1, 8, 3)}), 1U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(1, 1, 8, 3), segment(2, 8, 3, 4)}), 1U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(1, 5, 78, 5)}), 8U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(5, 1, 5, 58)}), 6U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(1, 5, 78, 5), segment(5, 1, 5, 58)}), 13U);
}

TEST(TouchedCells, FollowsTheLineThroughTheGrid) {
  // From the first cell over its right neighbour into the one below that.
  EXPECT_EQ(touchedCells("f", kSize, {segment(6, 4, 15, 13)}), 3U);
  // Exactly through the corner: the two cells beside it are touched in that point.
  EXPECT_EQ(touchedCells("f", kSize, {segment(4.5, 4.5, 14.5, 14.5)}), 4U);
}

TEST(TouchedCells, BordersBelongToBothSides) {
  EXPECT_EQ(touchedCells("f", kSize, {segment(9.5, 2, 9.5, 8)}), 2U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(9.25, 2, 9.25, 8)}), 1U);
}

TEST(TouchedCells, PartsOutsideTheImageTouchNothing) {
  EXPECT_EQ(touchedCells("f", kSize, {segment(-50, 5, 5, 5)}), 1U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(-50, 5, -10, 5)}), 0U);
  EXPECT_EQ(touchedCells("f", kSize, {segment(-1e9, 5, 1e9, 5)}), 8U);
}

TEST(TouchedCells, PointsTouchTheirCell) {
  EXPECT_EQ(touchedCells("f", kSize, {segment(5, 5, 5, 5)}), 1U);
}

TEST(TouchedCells, RefusesBadInput) {
  test::expectError([] { touchedCells("0004", kSize, {segment(1, INFINITY, 2, 2)}); },
                    {"0004", "row 0", "1,inf,2,2"});
  test::expectError([] { touchedCells("0004", {0, 0}, {}); }, {"0004", "0 x 0"});
  test::expectError([] { touchedCells("0004", kSize, {}, {0, 6}); }, {"0 x 6"});
  test::expectError([] { SpatialSpread spread({3, -1}); }, {"3 x -1"});
}

TEST(TouchedCells, IsBlindToOrderAndGrowsWithLines) {
  test::RandomLines random(8);
  LineSegments lines = random.anywhere(30, 90, 70);
  std::size_t before = 0;
  for (std::size_t count = 0; count <= lines.size(); ++count) {
    const std::size_t touched = touchedCells(
        "f", kSize, {lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(count)});
    EXPECT_GE(touched, before);
    before = touched;
  }
  EXPECT_GT(before, 20U);
  random.shuffle(&lines);
  for (LineSegment& line : lines) {
    std::swap(line.x1, line.x2);
    std::swap(line.y1, line.y2);
  }
  EXPECT_EQ(touchedCells("f", kSize, lines), before);
}

TEST(SpatialSpread, IsTheMeanOverFrames) {
  SpatialSpread spread;
  EXPECT_EQ(spread.share(), 0);
  EXPECT_EQ(spread.addFrame("a", kSize, {segment(1, 5, 78, 5)}), 8.0 / 48);
  EXPECT_EQ(spread.addFrame("b", kSize, {}), 0);
  EXPECT_EQ(spread.share(), 4.0 / 48);
  SpatialSpread other;
  other.addFrame("c", kSize, {segment(5, 1, 5, 58)});
  other.merge(spread);
  EXPECT_EQ(other.frames(), 3U);
  EXPECT_DOUBLE_EQ(other.share(), 14.0 / 48 / 3);
  EXPECT_THROW(other.merge(SpatialSpread({4, 4})), Error);
  other.reset();
  EXPECT_EQ(other.frames(), 0U);
  EXPECT_EQ(other.share(), 0);
}

}  // namespace
}  // namespace evolin
