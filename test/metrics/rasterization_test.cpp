// Lines as pixels: cases worked out by hand, what must not matter, and what must be refused.
#include "evolin_ros/metrics/rasterization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <set>
#include <utility>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {

/// What googletest shows of a pixel.
static std::ostream& operator<<(std::ostream& stream, const Pixel& pixel) {
  return stream << pixel.x << "," << pixel.y;
}

namespace {

constexpr ImageSize kSize{640, 480};

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

Pixels drawn(const LineSegment& line, ImageSize size = kSize) {
  Pixels pixels;
  rasterize(line, size, &pixels);
  return pixels;
}

LineSegment exchanged(LineSegment line) {
  std::swap(line.x1, line.x2);
  std::swap(line.y1, line.y2);
  return line;
}

std::set<std::pair<int, int>> setOf(const Pixels& pixels) {
  std::set<std::pair<int, int>> set;
  for (const Pixel& pixel : pixels) {
    set.emplace(pixel.x, pixel.y);
  }
  return set;
}

TEST(Rasterization, RoundsHalvesToEven) {
  // Rows 0, 0.5, 1, 1.5, 2.
  EXPECT_EQ(drawn(segment(0, 0, 4, 2)), (Pixels{{0, 0}, {1, 0}, {2, 1}, {3, 2}, {4, 2}}));
  EXPECT_EQ(drawn(segment(0, 1, 4, 3)), (Pixels{{0, 1}, {1, 2}, {2, 2}, {3, 2}, {4, 3}}));
}

TEST(Rasterization, TakesOneSampleAPixelOfTheLongerAxis) {
  // Columns 1, 1.5, 2, 2.5, 3 from the other axis, upwards.
  EXPECT_EQ(drawn(segment(1, 9, 3, 5)), (Pixels{{1, 9}, {2, 8}, {2, 7}, {2, 6}, {3, 5}}));
  // Rows 7, 7.33.., 7.66.., 8.
  EXPECT_EQ(drawn(segment(5, 7, 2, 8)), (Pixels{{5, 7}, {4, 7}, {3, 8}, {2, 8}}));
  EXPECT_EQ(drawn(segment(2, 2, 5, 5)), (Pixels{{2, 2}, {3, 3}, {4, 4}, {5, 5}}));
}

TEST(Rasterization, KeepsExactlyHorizontalAndVerticalLinesAndPoints) {
  EXPECT_EQ(drawn(segment(3, 7, 0, 7)), (Pixels{{3, 7}, {2, 7}, {1, 7}, {0, 7}}));
  EXPECT_EQ(drawn(segment(3, 7, 3, 9)), (Pixels{{3, 7}, {3, 8}, {3, 9}}));
  EXPECT_EQ(drawn(segment(3, 7, 3, 7)), (Pixels{{3, 7}}));
}

TEST(Rasterization, CutsEndpointsTowardsZero) {
  EXPECT_EQ(drawn(segment(0.9, 5.999, 2.5, 5.01)), (Pixels{{0, 5}, {1, 5}, {2, 5}}));
  EXPECT_EQ(drawn(segment(-0.9, -0.5, -0.1, 0.9)), (Pixels{{0, 0}}));
}

TEST(Rasterization, ClampsEndpointsToTheImageOneByOne) {
  EXPECT_EQ(drawn(segment(-3, -8, 2, 1), {3, 2}), drawn(segment(0, 0, 2, 1), {3, 2}));
  EXPECT_EQ(drawn(segment(1, 1, 700, 500), {3, 2}), (Pixels{{1, 1}, {2, 1}}));
  EXPECT_EQ(drawn(segment(-50, 900, -60, 901)), (Pixels{{0, 479}}));
  EXPECT_EQ(drawn(segment(-1e300, 3, 1e300, 3), {3, 8}), (Pixels{{0, 3}, {1, 3}, {2, 3}}));
}

TEST(Rasterization, AppendsToWhatIsThere) {
  Pixels pixels = {{9, 9}};
  rasterize(segment(1, 2, 2, 2), kSize, &pixels);
  EXPECT_EQ(pixels, (Pixels{{9, 9}, {1, 2}, {2, 2}}));
}

TEST(Rasterization, IsConnectedWithoutRepeatsWithinHalfAPixelOfTheLine) {
  test::RandomLines random(3);
  for (const LineSegment& line : random.anywhere(300, kSize.width, kSize.height)) {
    const Pixels pixels = drawn(line);
    const int x1 = static_cast<int>(line.x1);
    const int y1 = static_cast<int>(line.y1);
    const int x2 = static_cast<int>(line.x2);
    const int y2 = static_cast<int>(line.y2);
    EXPECT_EQ(pixels.front(), (Pixel{x1, y1}));
    EXPECT_EQ(pixels.back(), (Pixel{x2, y2}));
    ASSERT_EQ(static_cast<int>(pixels.size()), std::max(std::abs(x2 - x1), std::abs(y2 - y1)) + 1);
    EXPECT_EQ(setOf(pixels).size(), pixels.size());
    for (std::size_t i = 1; i < pixels.size(); ++i) {
      EXPECT_LE(std::abs(pixels[i].x - pixels[i - 1].x), 1);
      EXPECT_LE(std::abs(pixels[i].y - pixels[i - 1].y), 1);
      const double share = static_cast<double>(i) / static_cast<double>(pixels.size() - 1);
      EXPECT_NEAR(pixels[i].x, x1 + share * (x2 - x1), 0.5 + 1e-9);
      EXPECT_NEAR(pixels[i].y, y1 + share * (y2 - y1), 0.5 + 1e-9);
    }
  }
}

TEST(Rasterization, ExchangedEndpointsGiveTheSamePixelsWhereNoHalfIsInTheWay) {
  // An even number of steps that is no power of two may have samples at inexact halves.
  test::RandomLines random(4);
  int compared = 0;
  for (const LineSegment& line : random.anywhere(400, kSize.width, kSize.height)) {
    const std::size_t steps = drawn(line).size() - 1;
    if (steps % 2 == 1) {
      ++compared;
      EXPECT_EQ(setOf(drawn(line)), setOf(drawn(exchanged(line))));
    }
  }
  EXPECT_GT(compared, 100);
  // Exact halves round to even from either end.
  EXPECT_EQ(setOf(drawn(segment(0, 0, 4, 2))), setOf(drawn(segment(4, 2, 0, 0))));
}

TEST(Rasterization, ShiftsWithTheLineByEvenPixels) {
  test::RandomLines random(5);
  for (LineSegment line : random.anywhere(200, 200, 200)) {
    line.x1 = std::floor(line.x1);
    line.y1 = std::floor(line.y1);
    line.x2 = line.x1 + 64;  // steps are binary fractions: no rounding errors anywhere
    line.y2 = line.y1 + std::floor(random.uniform(-30, 30));
    line.y1 += 40;
    line.y2 += 40;
    Pixels shifted = drawn(segment(line.x1 + 100, line.y1 + 20, line.x2 + 100, line.y2 + 20));
    for (Pixel& pixel : shifted) {
      pixel.x -= 100;
      pixel.y -= 20;
    }
    EXPECT_EQ(drawn(line), shifted);
  }
}

TEST(Rasterization, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Pixels pixels;
  for (const LineSegment& line : {segment(nan, 0, 1, 1), segment(0, nan, 1, 1),
                                  segment(0, 0, infinity, 1), segment(0, 0, 1, -infinity)}) {
    test::expectError([&] { rasterize(line, kSize, &pixels); }, {"expected finite coordinates"});
  }
  test::expectError([&] { rasterize(segment(nan, 2, 3, 4), kSize, &pixels); }, {"nan,2,3,4"});
  EXPECT_TRUE(pixels.empty());
}

TEST(Rasterization, RefusesAnImageWithoutSize) {
  Pixels pixels;
  for (const ImageSize size : {ImageSize{0, 5}, ImageSize{5, 0}, ImageSize{-1, 5}}) {
    test::expectError([&] { rasterize(segment(0, 0, 1, 1), size, &pixels); }, {"positive size"});
  }
}

}  // namespace
}  // namespace evolin
