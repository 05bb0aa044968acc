// Trails along matches and ids: who follows whom, for how long, and what is forgotten.
#include "evolin_ros/drawing/line_trails.h"

#include <gtest/gtest.h>

#include "test/support/expect_error.h"

namespace evolin {
namespace {

/// A short line around (x, y).
LineSegment at(double x, double y, std::int64_t id = kNoId) {
  LineSegment line;
  line.x1 = x - 2;
  line.x2 = x + 2;
  line.y1 = line.y2 = y;
  line.id = id;
  return line;
}

using Points = std::vector<cv::Point2d>;

TEST(LineTrails, FollowMatchesFromFrameToFrame) {
  LineTrails trails(10, 5);
  EXPECT_TRUE(trails.add(1, {at(10, 0), at(20, 0)}, 0, {}).empty());
  const std::vector<LineTrail> second = trails.add(2, {at(21, 1), at(11, 1)}, 1, {{0, 1}, {1, 0}});
  ASSERT_EQ(second.size(), 2U);
  EXPECT_EQ(second[0].row, 0U);
  EXPECT_EQ(second[0].points, (Points{{20, 0}, {21, 1}}));
  EXPECT_EQ(second[1].points, (Points{{10, 0}, {11, 1}}));
  EXPECT_NE(second[0].track, second[1].track);

  const std::vector<LineTrail> third = trails.add(3, {at(50, 50), at(22, 2)}, 2, {{0, 1}});
  ASSERT_EQ(third.size(), 1U);
  EXPECT_EQ(third[0].row, 1U);
  EXPECT_EQ(third[0].track, second[0].track);
  EXPECT_EQ(third[0].points, (Points{{20, 0}, {21, 1}, {22, 2}}));
}

TEST(LineTrails, KeepTheLastPointsOnly) {
  LineTrails trails(3, 2);
  trails.add(0, {at(0, 0)});
  std::vector<LineTrail> last;
  for (Stamp stamp = 1; stamp <= 6; ++stamp) {
    last = trails.add(stamp, {at(static_cast<double>(stamp), 0)}, stamp - 1, {{0, 0}});
  }
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0].points, (Points{{4, 0}, {5, 0}, {6, 0}}));
}

TEST(LineTrails, MatchesMayReachOverFrames) {
  LineTrails trails(10, 3);
  trails.add(1, {at(1, 0)});
  trails.add(2, {at(2, 0)});
  const std::vector<LineTrail> third = trails.add(3, {at(3, 0)}, 1, {{0, 0}});
  ASSERT_EQ(third.size(), 1U);
  EXPECT_EQ(third[0].points, (Points{{1, 0}, {3, 0}}));
  // Frame 2 is remembered, frame 1 is not any more.
  EXPECT_EQ(trails.add(4, {at(4, 0)}, 2, {{0, 0}}).size(), 1U);
  EXPECT_TRUE(trails.add(5, {at(5, 0)}, 1, {{0, 0}}).empty());
}

TEST(LineTrails, RowsThatAreNotThereAndSecondMatchesJoinNothing) {
  LineTrails trails(10, 3);
  trails.add(1, {at(1, 0), at(2, 0)});
  const std::vector<LineTrail> joined =
      trails.add(2, {at(9, 9)}, 1, {{7, 0}, {0, 7}, {1, 0}, {0, 0}});
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined[0].points.front(), cv::Point2d(2, 0));
}

TEST(LineTrails, ALinesIdIsItsTrack) {
  LineTrails trails(10, 3);
  trails.add(1, {at(1, 0, 42)});
  EXPECT_EQ(trails.add(2, {at(2, 0, 42)}, 1, {{0, 0}}).at(0).track, 42);
}

TEST(LineTrails, FollowIdsWithoutMatches) {
  LineTrails trails(10, 3);
  EXPECT_TRUE(trails.addById(1, {at(1, 0, 7), at(5, 5), at(6, 6, 8)}).empty());
  const std::vector<LineTrail> second = trails.addById(2, {at(5, 5), at(2, 0, 7), at(3, 3, 9)});
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].row, 1U);
  EXPECT_EQ(second[0].track, 7);
  EXPECT_EQ(second[0].points, (Points{{1, 0}, {2, 0}}));
  test::expectError<GroundTruthError>(
      [&] {
        trails.addById(3, {at(1, 1, 7), at(2, 2, 7)});
      },
      {"7"});
}

TEST(LineTrails, AreForgottenWhenTimeJumps) {
  LineTrails trails(10, 3);
  trails.add(1, {at(1, 0)});
  trails.clear();
  EXPECT_TRUE(trails.add(2, {at(2, 0)}, 1, {{0, 0}}).empty());
}

}  // namespace
}  // namespace evolin
