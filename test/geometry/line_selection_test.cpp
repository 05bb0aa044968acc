// Thresholds on lines by hand.
#include "evolin_ros/geometry/line_selection.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace evolin {
namespace {

/// A horizontal line of this length; `id` tells it apart.
LineSegment line(std::int64_t id, double length, double score = kNoScore) {
  LineSegment segment{0, 0, length, 0};
  segment.score = score;
  segment.id = id;
  return segment;
}

std::vector<std::int64_t> kept(const LineSegments& lines, const LineSelection& selection) {
  std::vector<std::int64_t> ids;
  for (const LineSegment& segment : selectLines(lines, selection)) {
    ids.push_back(segment.id);
  }
  return ids;
}

using Ids = std::vector<std::int64_t>;

TEST(LineSelection, KeepsAllByDefault) {
  EXPECT_TRUE(LineSelection().keepsAll());
  EXPECT_EQ(kept({line(0, 0), line(1, 5, -2e6)}, {}), (Ids{0, 1}));
}

TEST(LineSelection, KeepsScoresAboveTheThreshold) {
  LineSelection selection;
  selection.score_threshold = -2;
  EXPECT_FALSE(selection.keepsAll());
  EXPECT_EQ(kept({line(0, 9, -2.5), line(1, 9, -2), line(2, 9, -1), line(3, 9)}, selection),
            (Ids{2, 3}));
}

TEST(LineSelection, KeepsTheLengthItself) {
  LineSelection selection;
  selection.min_length = 5;
  EXPECT_EQ(kept({line(0, 4.999), line(1, 5), line(2, 0), line(3, 6)}, selection), (Ids{1, 3}));
}

TEST(LineSelection, KeepsTheBestInTheirOrder) {
  LineSelection selection;
  selection.max_lines = 2;
  EXPECT_EQ(kept({line(0, 9, 1), line(1, 1, 3), line(2, 5, 2), line(3, 7)}, selection),
            (Ids{1, 2}));
  EXPECT_EQ(kept({line(0, 3), line(1, 9), line(2, 1), line(3, 9), line(4, 9)}, selection),
            (Ids{1, 3}));
  EXPECT_EQ(kept({line(0, 3), line(1, 9)}, selection), (Ids{0, 1}));
  EXPECT_EQ(kept({}, selection), Ids{});
}

TEST(LineSelection, CutsTheNumberAfterTheThresholds) {
  LineSelection selection;
  selection.min_length = 4;
  selection.max_lines = 1;
  EXPECT_EQ(kept({line(0, 3, 99), line(1, 4, 1), line(2, 9, 0)}, selection), Ids{1});
}

}  // namespace
}  // namespace evolin
