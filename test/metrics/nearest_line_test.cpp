// The quick search for nearest lines against an exhaustive one.
#include "src/metrics/nearest_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "test/metrics/mixed_lines.h"

namespace evolin {
namespace {

using test::segment;

double distanceBetween(LineDistance distance, const LineSegment& a, const LineSegment& b,
                       bool gate) {
  return distance == LineDistance::kStructural ? structuralDistance(a, b)
                                               : orthogonalDistance(a, b, gate);
}

NearestLine exhaustive(LineDistance distance, const LineSegment& query, const LineSegments& lines,
                       double reach, bool gate) {
  NearestLine nearest;
  for (std::uint32_t row = 0; row < lines.size(); ++row) {
    const double found = distanceBetween(distance, query, lines[row], gate);
    if (found <= reach && found < nearest.distance) {
      nearest = {row, found};
    }
  }
  return nearest;
}

class NearestLineSearchTest
    : public ::testing::TestWithParam<std::tuple<std::size_t, LineDistance, bool>> {};

TEST_P(NearestLineSearchTest, AnswersAsAnExhaustiveSearchDoes) {
  const auto [count, distance, gate] = GetParam();
  test::RandomLines random(count + 1);
  const LineSegments lines = test::mixedLines(count, &random);
  LineSegments queries = test::mixedLines(200, &random);
  queries.insert(queries.end(), lines.begin(),
                 lines.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(count, 100)));
  NearestLineSearch search(lines);
  int found = 0;
  for (const LineSegment& query : queries) {
    for (const double reach : {0.0, 0.5, 5.0, 15.0, 60.0, 600.0}) {
      const NearestLine expected = exhaustive(distance, query, lines, reach, gate);
      const NearestLine actual = search.find(distance, query, reach, gate);
      ASSERT_EQ(actual.distance, expected.distance) << "reach " << reach;
      if (std::isfinite(expected.distance)) {
        ASSERT_EQ(actual.row, expected.row) << "reach " << reach;
        ++found;
      }
      const NearestLine both = search.findBoth(query, reach, gate).of(distance);
      ASSERT_EQ(both.distance, expected.distance) << "reach " << reach;
      ASSERT_EQ(both.row, actual.row) << "reach " << reach;
    }
  }
  if (count > 50) {
    EXPECT_GT(found, 300);
  }
}

INSTANTIATE_TEST_SUITE_P(
    SizesDistancesGates, NearestLineSearchTest,
    ::testing::Combine(::testing::Values<std::size_t>(0, 1, 2, 8, 9, 80, 300, 700),
                       ::testing::Values(LineDistance::kOrthogonal, LineDistance::kStructural),
                       ::testing::Bool()));

TEST(NearestLineSearch, TiesGoToTheLowestRow) {
  // Five rows away on either side, whatever the order of their midpoints.
  for (const std::size_t count : {2U, 400U}) {
    LineSegments lines(count, segment(90, 90, 95, 99));
    lines[count - 2] = segment(25, 10, 45, 30);
    lines[count - 1] = segment(15, 10, 35, 30);
    NearestLineSearch search(lines);
    for (const bool gate : {false, true}) {
      for (const LineDistance distance : {LineDistance::kOrthogonal, LineDistance::kStructural}) {
        EXPECT_EQ(search.find(distance, segment(20, 10, 40, 30), 15, gate).row, count - 2);
      }
    }
  }
}

TEST(NearestLineSearch, LinesOfOneMidpointAndFarAwayLinesAreFound) {
  LineSegments lines(300, segment(10, 20, 30, 40));
  lines[299] = segment(10, 40, 30, 20);
  NearestLineSearch same(lines);
  EXPECT_EQ(same.find(LineDistance::kStructural, segment(10, 40, 30, 20), 15, true).row, 299U);
  EXPECT_EQ(same.find(LineDistance::kOrthogonal, segment(10, 40, 30, 20), 15, true).row, 299U);
  lines[0] = segment(-1e6, 5, -1e6 + 9, 7);
  NearestLineSearch wide(lines);
  EXPECT_EQ(wide.find(LineDistance::kStructural, lines[0], 15, true).row, 0U);
  EXPECT_EQ(wide.find(LineDistance::kOrthogonal, lines[0], 15, true).row, 0U);
}

}  // namespace
}  // namespace evolin
