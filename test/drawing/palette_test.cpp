// Colours of numbers: stable, vivid, and apart for neighbours.
#include "evolin_ros/drawing/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evolin {
namespace {

int difference(const Colour& a, const Colour& b) {
  return std::max(
      {std::abs(a.red - b.red), std::abs(a.green - b.green), std::abs(a.blue - b.blue)});
}

TEST(ColourOfNumber, IsRedForZeroAndStable) {
  EXPECT_EQ(colourOfNumber(0), (Colour{255, 0, 0}));
  EXPECT_EQ(colourOfNumber(17), colourOfNumber(17));
}

TEST(ColourOfNumber, IsVividForAnyNumber) {
  for (const std::int64_t number :
       {std::int64_t{-1}, std::int64_t{5}, std::int64_t{123456789},
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    const Colour colour = colourOfNumber(number);
    EXPECT_EQ(std::max({colour.red, colour.green, colour.blue}), 255) << number;
    EXPECT_EQ(std::min({colour.red, colour.green, colour.blue}), 0) << number;
  }
}

TEST(ColourOfNumber, NeighboursAreApart) {
  for (std::int64_t number = 0; number < 1000; ++number) {
    EXPECT_GT(difference(colourOfNumber(number), colourOfNumber(number + 1)), 100) << number;
    EXPECT_GT(difference(colourOfNumber(number), colourOfNumber(number + 2)), 60) << number;
  }
}

/// WCAG's relative luminance.
double luminance(const Colour& colour) {
  const auto linear = [](std::uint8_t value) {
    const double share = value / 255.0;
    return share <= 0.03928 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

TEST(Palette, InkIsReadableOnPaper) {
  for (const Colour& ink : {palette::kInk, palette::kFaintInk}) {
    EXPECT_GE((luminance(ink) + 0.05) / (luminance(palette::kPaper) + 0.05), 4.5);
  }
}

}  // namespace
}  // namespace evolin
