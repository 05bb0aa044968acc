// Reading clouds of lines: ids, cameras, and everything that such a cloud may have wrong.
#include "line_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

using test::expectError;

/// As PL-VIO writes them.
void addLine(float code, float x1, float y1, float x2, float y2, sensor_msgs::PointCloud* cloud) {
  cloud->channels.resize(3);
  geometry_msgs::Point32 start;
  start.x = x1;
  start.y = y1;
  start.z = 1;
  cloud->points.push_back(start);
  cloud->channels[0].values.push_back(code);
  cloud->channels[1].values.push_back(x2);
  cloud->channels[2].values.push_back(y2);
}

sensor_msgs::PointCloud handMade() {
  sensor_msgs::PointCloud cloud;
  cloud.header.frame_id = "world";
  addLine(14, 0.25F, -0.5F, 0.375F, 0.125F, &cloud);
  addLine(7, 0.5F, 0.5F, -0.25F, 0.75F, &cloud);
  addLine(0, -0.5F, 0, 0.5F, 0, &cloud);
  return cloud;
}

Camera camera() {
  Camera result;
  result.width = 640;
  result.height = 480;
  result.fx = result.fy = 400;
  result.cx = 320;
  result.cy = 240;
  return result;
}

TEST(LineCloud, OfOneCameraHasItsIdsAsTheyAre) {
  LineCloud cloud = readLineCloud(handMade(), {});
  ASSERT_EQ(cloud.lines.size(), 3U);
  EXPECT_EQ(cloud.lines[0].id, 14);
  EXPECT_EQ(cloud.lines[1].id, 7);
  EXPECT_EQ(cloud.lines[2].id, 0);
  EXPECT_EQ(cloud.lines[1].start, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(cloud.lines[1].end, Eigen::Vector2d(-0.25, 0.75));
  EXPECT_EQ(cloud.unusable + cloud.other_cameras, 0U);
  EXPECT_FALSE(cloud.inexact_ids);
  const LineSegments lines = toPixels(ImageView::distorted(camera()), &cloud);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].x1, 420);
  EXPECT_EQ(lines[0].y1, 40);
  EXPECT_EQ(lines[0].x2, 470);
  EXPECT_EQ(lines[0].y2, 290);
  EXPECT_EQ(lines[0].id, 14);
  EXPECT_FALSE(lines[0].hasScore());
}

TEST(LineCloud, OfTwoCamerasGivesTheChosenOnes) {
  const LineCloud left = readLineCloud(handMade(), {2, 0});
  ASSERT_EQ(left.lines.size(), 2U);
  EXPECT_EQ(left.lines[0].id, 7);
  EXPECT_EQ(left.lines[1].id, 0);
  EXPECT_EQ(left.other_cameras, 1U);
  const LineCloud right = readLineCloud(handMade(), {2, 1});
  ASSERT_EQ(right.lines.size(), 1U);
  EXPECT_EQ(right.lines[0].id, 3);
  EXPECT_EQ(right.lines[0].start, Eigen::Vector2d(0.5, 0.5));
}

TEST(LineCloud, MayBeEmpty) {
  sensor_msgs::PointCloud cloud;
  cloud.channels.resize(3);
  EXPECT_TRUE(readLineCloud(cloud, {}).lines.empty());
}

TEST(LineCloud, OfAnotherKindIsRefused) {
  sensor_msgs::PointCloud points = handMade();
  points.channels.resize(5);
  expectError([&] { readLineCloud(points, {}); }, {"5 channels", "linefeature"});
  expectError([&] { readLineCloud({}, {}); }, {"0 channels"});
  sensor_msgs::PointCloud torn = handMade();
  torn.channels[2].values.pop_back();
  expectError([&] { readLineCloud(torn, {}); }, {"channel 2", "2 values for 3 points"});
  sensor_msgs::PointCloud spatial = handMade();
  spatial.points[1].z = 2.5;
  expectError([&] { readLineCloud(spatial, {}); }, {"point 1", "z = 2.5"});
  expectError([] { readLineCloud(handMade(), {2, 2}); }, {"camera_index is 2", "0 to 1"});
}

TEST(LineCloud, LeavesUnusableLinesOutAndCountsThem) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sensor_msgs::PointCloud message = handMade();
  addLine(1.5F, 0, 0, 0.1F, 0.1F, &message);
  addLine(-3, 0, 0, 0.1F, 0.1F, &message);
  addLine(nan, 0, 0, 0.1F, 0.1F, &message);
  addLine(5, 0, nan, 0.1F, 0.1F, &message);
  addLine(6, 0, 0, std::numeric_limits<float>::infinity(), 0.1F, &message);
  addLine(8, 0.1F, 0.1F, 0.2F, 0.1F, &message);
  const LineCloud cloud = readLineCloud(message, {});
  EXPECT_EQ(cloud.lines.size(), 4U);
  EXPECT_EQ(cloud.unusable, 5U);
  EXPECT_NE(cloud.first_problem.find("line 3 has the id 1.5"), std::string::npos)
      << cloud.first_problem;
}

TEST(LineCloud, CountsWhatTheLensModelDoesNotReach) {
  Camera folding = camera();
  folding.distortion = {-0.3, 0, 0, 0};
  sensor_msgs::PointCloud message = handMade();
  addLine(9, 2.5F, 0, 2.4F, 0.1F, &message);
  LineCloud cloud = readLineCloud(message, {});
  EXPECT_EQ(toPixels(ImageView::distorted(folding), &cloud).size(), 3U);
  EXPECT_EQ(cloud.unusable, 1U);
  EXPECT_NE(cloud.first_problem.find("id 9"), std::string::npos) << cloud.first_problem;
}

TEST(LineCloud, SaysWhereIdsAreNotExact) {
  sensor_msgs::PointCloud message;
  addLine(16777216.0F, 0, 0, 1, 1, &message);
  EXPECT_FALSE(readLineCloud(message, {}).inexact_ids);
  addLine(16777218.0F, 0, 0, 1, 1, &message);
  EXPECT_TRUE(readLineCloud(message, {}).inexact_ids);
  EXPECT_EQ(16777216.0F + 1.0F, 16777216.0F) << "which is why";
}

}  // namespace
}  // namespace evolin::ros_shell
