// Suppression of segments that repeat a better one.
#include "evolin_ros/inference/segment_suppression.h"

#include <gtest/gtest.h>

#include <limits>

namespace evolin {
namespace {

TEST(SegmentSuppression, TheBetterOfTwoNearOnesStays) {
  const LineSegments kept =
      suppressSegments({{0, 0, 10, 0, 0.3}, {1, 0, 11, 0, 0.9}, {0, 5, 10, 5, 0.5}}, 2);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].score, 0.9);
  EXPECT_EQ(kept[1].score, 0.5);
}

TEST(SegmentSuppression, TheDirectionOfASegmentIsNoDifference) {
  EXPECT_EQ(suppressSegments({{0, 0, 10, 0, 0.3}, {10, 0, 0, 0, 0.9}}, 0).size(), 1U);
}

TEST(SegmentSuppression, TheThresholdIsTheSumOfSquares) {
  const LineSegments lines = {{0, 0, 10, 0, 1}, {0, 1, 10, 1, 0.5}};
  EXPECT_EQ(suppressSegments(lines, 2).size(), 1U);
  EXPECT_EQ(suppressSegments(lines, 1.99).size(), 2U);
}

TEST(SegmentSuppression, WhatWasSuppressedSuppressesNothing) {
  const LineSegments kept =
      suppressSegments({{0, 0, 10, 0, 0.9}, {0, 2, 10, 2, 0.8}, {0, 4, 10, 4, 0.7}}, 8);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[1].score, 0.7);
}

TEST(SegmentSuppression, EqualAndMissingScoresKeepTheirOrder) {
  const LineSegments kept =
      suppressSegments({{0, 0, 1, 0}, {0, 9, 1, 9, 0.5}, {0, 99, 1, 99, 0.5}, {0, 199, 1, 199}}, 1);
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_EQ(kept[0].y1, 9);
  EXPECT_EQ(kept[1].y1, 99);
  EXPECT_EQ(kept[2].y1, 0);
  EXPECT_EQ(kept[3].y1, 199);
}

TEST(SegmentSuppression, SegmentsThatAreNotFiniteGo) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(suppressSegments({{0, 0, infinity, 0, 1}}, 1).empty());
  EXPECT_TRUE(suppressSegments({}, 1).empty());
}

}  // namespace
}  // namespace evolin
