// The number of false alarms of LSD's rectangles against sums by hand.
#include "lsd_validation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace evolin::lsd {
namespace {

/// A field in which every pixel of columns [10, 13] and rows [5, 24] is aligned upwards.
Field columnField() {
  Field field;
  field.width = 40;
  field.height = 30;
  field.angles.assign(1200, kNoAngle);
  field.magnitudes.assign(1200, 10);
  for (int y = 5; y < 25; ++y) {
    for (int x = 10; x < 14; ++x) {
      field.angles[static_cast<std::size_t>(y * 40 + x)] = static_cast<float>(CV_PI / 2);
    }
  }
  return field;
}

Rectangle column(double left, double right) {
  Rectangle r;
  r.x1 = r.x2 = (left + right) / 2;
  r.y1 = 5;
  r.y2 = 24;
  r.width = right - left;
  r.angle = CV_PI / 2;
  r.dx = 0;
  r.dy = 1;
  r.tolerance = CV_PI / 8;
  r.chance = 1.0 / 8;
  return r;
}

double binomialTail(int n, int k, double p) {
  double sum = 0;
  for (int i = k; i <= n; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(p) + (n - i) * std::log(1 - p));
  }
  return sum;
}

TEST(LsdValidation, NumberOfFalseAlarmsIsTestsTimesTail) {
  Validation validation(false);
  const Field field = columnField();
  validation.start(field);
  EXPECT_NEAR(validation.logTests(), 2.5 * std::log10(40.0 * 30.0) + std::log10(11.0), 1e-12);
  for (const int n : {1, 2, 10, 60, 300}) {
    for (int k = 1; k <= n; k += 1 + n / 7) {
      const double expected = -std::log10(binomialTail(n, k, 0.125)) - validation.logTests();
      // The tail's sum ends where the rest is below a tenth of the result.
      EXPECT_NEAR(validation.logNfa(n, k, 0.125), expected, 0.1 * std::abs(expected) + 0.05)
          << k << " of " << n;
    }
  }
  EXPECT_EQ(validation.logNfa(0, 0, 0.125), -validation.logTests());
  EXPECT_EQ(validation.logNfa(9, 0, 0.125), -validation.logTests());
}

TEST(LsdValidation, ManyPixelsDoNotUnderflow) {
  Validation validation(false);
  const Field field = columnField();
  validation.start(field);
  const double score = validation.logNfa(3000, 2900, 0.125);
  EXPECT_TRUE(std::isfinite(score));
  EXPECT_GT(score, 2000);
}

TEST(LsdValidation, CountsThePixelsOfARectangle) {
  const Field field = columnField();
  Validation validation(false);
  validation.start(field);
  // 80 pixels, all aligned; then a column to the right that is not.
  EXPECT_DOUBLE_EQ(validation.logNfa(column(9.9, 13.1)), validation.logNfa(80, 80, 0.125));
  EXPECT_DOUBLE_EQ(validation.logNfa(column(9.9, 14.1)), validation.logNfa(100, 80, 0.125));
}

// Of a rectangle along the columns the published library sees the left column only.
TEST(LsdValidation, WholePixelsCountAsThePublishedLibrary) {
  const Field field = columnField();
  Validation validation(true);
  validation.start(field);
  EXPECT_DOUBLE_EQ(validation.logNfa(column(10.2, 13.4)), validation.logNfa(20, 20, 0.125));
  EXPECT_DOUBLE_EQ(validation.logNfa(column(9.9, 13.1)), -validation.logTests());
}

TEST(LsdValidation, ImprovesARectangleThatIsTooWide) {
  const Field field = columnField();
  Validation validation(false);
  validation.start(field);
  Rectangle wide = column(8.0, 16.0);
  const double before = validation.logNfa(wide);
  const double after = validation.improve(1000, &wide);
  EXPECT_GT(after, before);
  EXPECT_DOUBLE_EQ(after, validation.logNfa(wide));
  EXPECT_LT(wide.width, 8);
}

TEST(LsdValidation, LeavesAGoodRectangleAlone) {
  const Field field = columnField();
  Validation validation(false);
  validation.start(field);
  Rectangle good = column(9.9, 14.1);
  const double score = validation.improve(0, &good);
  EXPECT_DOUBLE_EQ(good.width, column(9.9, 14.1).width);
  EXPECT_DOUBLE_EQ(score, validation.logNfa(good));
}

}  // namespace
}  // namespace evolin::lsd
