// Trajectory files and the look-up of a pose by time.
#include "evolin_ros/dataset/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <string>

#include "test/support/expect_error.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::TemporaryFolder;

constexpr Stamp kMillisecond = kNanosecondsPerSecond / 1000;

StampedPose poseAt(Stamp stamp, double x) {
  StampedPose pose;
  pose.stamp = stamp;
  pose.pose.translation = {x, 0, 0};
  return pose;
}

TEST(Trajectory, InterpolatesBetweenTwoNeighbours) {
  const Trajectory trajectory({poseAt(0, 0), poseAt(100 * kMillisecond, 10)});
  const std::optional<Pose> pose = trajectory.at(30 * kMillisecond);
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->translation.x(), 3, 1e-12);
}

TEST(Trajectory, HasNoPoseWhenOneNeighbourIsTooFar) {
  const Trajectory trajectory({poseAt(0, 0), poseAt(150 * kMillisecond, 15)});
  EXPECT_TRUE(trajectory.at(50 * kMillisecond).has_value());
  EXPECT_TRUE(trajectory.at(100 * kMillisecond).has_value());
  EXPECT_FALSE(trajectory.at(49 * kMillisecond).has_value());
  EXPECT_FALSE(trajectory.at(101 * kMillisecond).has_value());
}

TEST(Trajectory, HasNoPoseOutsideItsRange) {
  const Trajectory trajectory({poseAt(kMillisecond, 0), poseAt(2 * kMillisecond, 1)});
  EXPECT_FALSE(trajectory.at(0).has_value());
  EXPECT_FALSE(trajectory.at(3 * kMillisecond).has_value());
  EXPECT_FALSE(Trajectory().at(0).has_value());
}

TEST(Trajectory, TakesAPoseOfTheSameTimeWithoutNeighbours) {
  const Trajectory trajectory(
      {poseAt(0, 1), poseAt(kNanosecondsPerSecond, 2), poseAt(2 * kNanosecondsPerSecond, 3)});
  for (const Stamp off : {Stamp{-1000}, Stamp{0}, Stamp{1000}}) {
    const std::optional<Pose> pose = trajectory.at(kNanosecondsPerSecond + off);
    ASSERT_TRUE(pose.has_value()) << off;
    EXPECT_EQ(pose->translation.x(), 2);
  }
  EXPECT_FALSE(trajectory.at(kNanosecondsPerSecond + 1001).has_value());
  EXPECT_FALSE(trajectory.at(kNanosecondsPerSecond - 1001).has_value());
}

TEST(Trajectory, TakesTheNearerOfTwoPosesOfTheSameTime) {
  const Trajectory trajectory({poseAt(0, 1), poseAt(900, 2)});
  EXPECT_EQ(trajectory.at(300)->translation.x(), 1);
  EXPECT_EQ(trajectory.at(600)->translation.x(), 2);
}

TEST(Trajectory, RefusesStampsThatDoNotIncrease) {
  expectError([] { Trajectory({poseAt(5, 0), poseAt(5, 1)}); }, {"0.000000005", "increasing"});
}

TEST(Trajectory, ForgetsOnlyWhatNoLaterLookUpNeeds) {
  Trajectory trajectory;
  Trajectory whole;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(trajectory.add(poseAt(i * 10 * kMillisecond, i)));
    ASSERT_TRUE(whole.add(poseAt(i * 10 * kMillisecond, i)));
    const Stamp oldest = std::max<Stamp>(0, (i - 20) * 10 * kMillisecond);
    trajectory.forgetBefore(oldest);
    // Those of the gap before and of the 20 after it, twice.
    ASSERT_LE(trajectory.poses().size(), 64U) << i;
    for (Stamp stamp = oldest; stamp <= i * 10 * kMillisecond; stamp += 3 * kMillisecond) {
      ASSERT_EQ(trajectory.at(stamp)->translation.x(), whole.at(stamp)->translation.x());
    }
  }
  trajectory.forgetBefore(1000 * kNanosecondsPerSecond);
  EXPECT_EQ(trajectory.poses().size(), 1U);
}

TEST(ReadTrajectory, SkipsCommentsAndNormalisesQuaternions) {
  const TemporaryFolder folder;
  const auto file = folder.write("groundtruth.txt",
                                 "# stamp tx ty tz qx qy qz qw\r\n\n"
                                 "1305031449.7996 1 2 3 0 0 0 2\n"
                                 "1305031449.8096\t4 5 6  3 0 0 4 \n");
  const Trajectory trajectory = readTrajectory(file);
  ASSERT_EQ(trajectory.poses().size(), 2U);
  EXPECT_EQ(trajectory.poses()[0].stamp, 1305031449799600000);
  EXPECT_EQ(trajectory.poses()[0].pose.rotation.w(), 1);
  EXPECT_NEAR(trajectory.poses()[1].pose.rotation.x(), 0.6, 1e-15);
  EXPECT_NEAR(trajectory.poses()[1].pose.rotation.w(), 0.8, 1e-15);
  EXPECT_EQ(trajectory.poses()[1].pose.translation.z(), 6);
}

TEST(ReadTrajectory, NamesFileLineAndValueOfWhatIsWrong) {
  const TemporaryFolder folder;
  const struct {
    std::string row;
    std::string said;
  } cases[] = {{"1 0 0 0 0 0 0 0", "0 0 0 0, expected one of non-zero norm"},
               {"1 0 0 0 0 0 0", "7 fields"},
               {"1 0 0 0 0 0 0 1 9", "9 fields"},
               {"1 0 zero 0 0 0 0 1", "zero"},
               {"1 nan 0 0 0 0 0 1", "nan"},
               {"1 0 0 0 0 0 0 inf", "inf"},
               {"one 0 0 0 0 0 0 1", "one"},
               {"0.5 0 0 0 0 0 0 1", "does not come after"},
               {"0.25 0 0 0 0 0 0 1", "0.25"}};
  for (const auto& bad : cases) {
    const auto file = folder.write("bad.txt", "# head\n0.5 0 0 0 0 0 0 1\n" + bad.row + "\n");
    expectError<ParseError>([&] { readTrajectory(file); }, {"bad.txt:3", bad.said});
  }
  expectError<ParseError>([&] { readTrajectory(folder.path() / "none.txt"); }, {"none.txt"});
}

TEST(ReadNumberedPoses, KeepsNumbersAndWantsThemWholeAndIncreasing) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("livingRoom2.gt.freiburg", "1 0 0 -2.25 0 0 0 1\n3 0 0 1 0 0 0 1\n");
  const std::vector<NumberedPose> poses = readNumberedPoses(file);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].number, 1);
  EXPECT_EQ(poses[1].number, 3);
  EXPECT_EQ(poses[0].pose.translation.z(), -2.25);
  const auto fraction = folder.write("a.txt", "1.5 0 0 0 0 0 0 1\n");
  expectError<ParseError>([&] { readNumberedPoses(fraction); }, {"a.txt:1", "1.5", "whole"});
  const auto repeated = folder.write("b.txt", "2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  expectError<ParseError>([&] { readNumberedPoses(repeated); }, {"b.txt:2", "increasing"});
}

TEST(ReadPoseRows, IgnoresTheFirstColumn) {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.txt", "7 1 0 0 0 0 0 1\nname 2 0 0 0 0 0 1\n");
  const std::vector<Pose> poses = readPoseRows(file);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].translation.x(), 2);
}

TEST(ReadTrajectory, ReadsARealTrajectory) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Trajectory trajectory =
      readTrajectory(test::sharedFolder() / "data/tum_fr1_desk_sample/groundtruth.txt");
  EXPECT_EQ(trajectory.poses().size(), 2335U);
  // Half way between the first two rows: tx is 1.2334 in both, tz goes from 1.6941 to 1.6939.
  const std::optional<Pose> pose = trajectory.at(*parseStamp("1305031449.8046"));
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->translation.x(), 1.2334, 1e-12);
  EXPECT_NEAR(pose->translation.z(), 1.6940, 1e-12);
}

TEST(Trajectory, ForgetsWhatNoLaterLookUpNeeds) {
  constexpr Stamp kPeriod = kNanosecondsPerSecond / 100;
  Trajectory all;
  Trajectory forgetful;
  std::size_t most = 0;
  for (int i = 0; i < 2000; ++i) {
    Pose pose;
    pose.translation.x() = i;
    all.add({i * kPeriod, pose});
    forgetful.add({i * kPeriod, pose});
    const Stamp bound = (i - 50) * kPeriod;
    forgetful.forgetBefore(bound);
    most = std::max(most, forgetful.poses().size());
    for (const Stamp stamp : {bound, bound + kPeriod / 3, i * kPeriod}) {
      const std::optional<Pose> expected = all.at(stamp);
      const std::optional<Pose> got = forgetful.at(stamp);
      ASSERT_EQ(got.has_value(), expected.has_value());
      if (got) {
        ASSERT_EQ(got->translation, expected->translation);
      }
    }
  }
  EXPECT_LT(most, 200U) << "61 are needed";
  forgetful.forgetBefore(1000 * kNanosecondsPerSecond);
  EXPECT_EQ(forgetful.poses().size(), 1U) << "poses were there";
}

}  // namespace
}  // namespace evolin
