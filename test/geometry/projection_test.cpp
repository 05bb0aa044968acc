// Depth look-up, back-projection, motion and projection of segments.
#include "evolin_ros/geometry/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

Camera iclCamera() {
  Camera camera;
  camera.fx = 481.2;
  camera.fy = -480;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

TEST(DepthMap, ReadsMetresAndStoredUnits) {
  cv::Mat metres(2, 3, CV_32FC1, cv::Scalar(1.5F));
  EXPECT_EQ(DepthMap(metres).at(2, 1), 1.5);
  cv::Mat units(2, 3, CV_16UC1, cv::Scalar(5001));
  EXPECT_EQ(DepthMap(units).at(0, 0), 5001 / 5000.0);  // in double precision
  EXPECT_EQ(DepthMap(units, 1000).at(0, 0), 5.001);
  EXPECT_EQ(DepthMap(units).size().width, 3);
  EXPECT_EQ(DepthMap(units).size().height, 2);
}

TEST(DepthMap, HasNoneWhereNothingWasMeasured) {
  cv::Mat metres(1, 6, CV_32FC1);
  metres.at<float>(0, 0) = 0;
  metres.at<float>(0, 1) = std::numeric_limits<float>::quiet_NaN();
  metres.at<float>(0, 2) = std::numeric_limits<float>::infinity();
  metres.at<float>(0, 3) = -1;
  metres.at<float>(0, 4) = -std::numeric_limits<float>::infinity();
  metres.at<float>(0, 5) = 1;
  const DepthMap depth(metres);
  for (int x = 0; x < 5; ++x) {
    EXPECT_FALSE(DepthMap::isDepth(depth.at(x, 0))) << x;
  }
  EXPECT_TRUE(DepthMap::isDepth(depth.at(5, 0)));
  EXPECT_FALSE(DepthMap::isDepth(DepthMap(cv::Mat(1, 1, CV_16UC1, cv::Scalar(0))).at(0, 0)));
  for (const auto& [x, y] : {std::pair(-1, 0), {0, -1}, {6, 0}, {0, 1}}) {
    EXPECT_EQ(depth.at(x, y), 0) << x << " " << y;
  }
  EXPECT_EQ(depth.at({{5, 0}, {0, 0}, {-1, -1}, {5, 0}}), (std::vector<double>{1, 0, 0, 1}));
}

TEST(DepthMap, GivesMetresRoundedOnceAndNanForNone) {
  cv::Mat units(2, 3, CV_16UC1, cv::Scalar(0));
  units.at<std::uint16_t>(1, 2) = 5001;
  const cv::Mat of_units = DepthMap(units, 1000).metres();
  ASSERT_EQ(of_units.type(), CV_32FC1);
  ASSERT_EQ(of_units.size(), cv::Size(3, 2));
  EXPECT_EQ(of_units.at<float>(1, 2), 5.001F);
  EXPECT_TRUE(std::isnan(of_units.at<float>(0, 0)));
  cv::Mat stored(1, 4, CV_32FC1, cv::Scalar(1.25));
  stored.at<float>(0, 1) = -2;
  stored.at<float>(0, 2) = std::numeric_limits<float>::infinity();
  const cv::Mat metres = DepthMap(stored).metres();
  EXPECT_EQ(metres.at<float>(0, 0), 1.25F);
  EXPECT_TRUE(std::isnan(metres.at<float>(0, 1)));
  EXPECT_TRUE(std::isnan(metres.at<float>(0, 2)));
  EXPECT_EQ(stored.at<float>(0, 1), -2) << "a copy";
}

TEST(DepthMap, RefusesWhatIsNoDepth) {
  test::expectError([] { DepthMap{cv::Mat()}; }, {"empty"});
  test::expectError([] { DepthMap{cv::Mat(2, 2, CV_8UC3)}; }, {"3 channels", "8 bits"});
  const cv::Mat units(2, 2, CV_16UC1, cv::Scalar(1));
  test::expectError([&] { DepthMap(units, 0); }, {"depth factor 0"});
  test::expectError([&] { DepthMap(units, std::nan("")); }, {"depth factor nan"});
}

TEST(BackProject, FollowsThePinholeWithNegativeFocalLength) {
  const Eigen::Vector3d point = backProject(iclCamera(), 319.5 + 481.2, 239.5 + 480, 2);
  EXPECT_NEAR(point.x(), 2, 1e-12);
  EXPECT_NEAR(point.y(), -2, 1e-12);
  EXPECT_EQ(point.z(), 2);
}

TEST(NearestPixel, RoundsHalvesToEven) {
  const ImageSize size{4, 3};
  EXPECT_EQ(nearestPixel(1.5, 0.5, size), cv::Point(2, 0));
  EXPECT_EQ(nearestPixel(2.5, 1.5, size), cv::Point(2, 2));
  EXPECT_EQ(nearestPixel(2.51, -0.5, size), cv::Point(3, 0));
}

TEST(NearestPixel, IsNoneOutsideTheImage) {
  const ImageSize size{4, 3};
  for (const auto& [x, y] : {std::pair(3.6, 0.0),
                             {-0.6, 0},
                             {0, 2.6},
                             {0, -1},
                             {1e300, 0},
                             {NAN, 0},
                             {0, NAN},
                             {-INFINITY, 0}}) {
    EXPECT_EQ(nearestPixel(x, y, size), cv::Point(-1, -1)) << x << " " << y;
  }
}

TEST(BackProject, GoesThroughPixelCentersOnRequest) {
  Camera camera = iclCamera();
  camera.cx = 0;
  const LineSegment line = segment(1.5, 2.5, 6, 7);
  const Segment3d centered = backProject(camera, line, {3, 4}, true);
  EXPECT_EQ(centered.p1.z(), 3);
  EXPECT_EQ(centered.p2.z(), 4);
  EXPECT_NEAR(centered.p1.x(), 2 * 3 / camera.fx, 1e-12);
  EXPECT_NEAR(centered.p1.y(), (2 - camera.cy) * 3 / camera.fy, 1e-12);
  const Segment3d exact = backProject(camera, line, {3, 4}, false);
  EXPECT_NEAR(exact.p1.x(), 1.5 * 3 / camera.fx, 1e-12);
  EXPECT_NEAR(exact.p1.y(), (2.5 - camera.cy) * 3 / camera.fy, 1e-12);
}

TEST(EndpointDepths, AreKnownAtBothEndsOrNotAtAll) {
  EXPECT_TRUE((EndpointDepths{1, 2}.areKnown()));
  EXPECT_FALSE((EndpointDepths{0, 2}.areKnown()));
  EXPECT_FALSE((EndpointDepths{1, NAN}.areKnown()));
}

Pose turnedPose(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& at) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(degrees * EIGEN_PI / 180, axis.normalized());
  pose.translation = at;
  return pose;
}

TEST(MotionBetween, TakesPointsThroughTheWorld) {
  const Pose first = turnedPose(30, {1, 2, 3}, {0.5, -1, 2});
  const Pose second = turnedPose(-20, {0, 1, 1}, {1, 1, 0});
  const Eigen::Vector3d point(0.3, 0.2, 4);
  const Eigen::Vector3d world = first.rotation * point + first.translation;
  const Eigen::Vector3d expected = second.rotation.inverse() * (world - second.translation);
  EXPECT_LT((motionBetween(first, second) * point - expected).norm(), 1e-12);
  EXPECT_TRUE(motionBetween(first, first).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(Project, UndoesBackProjection) {
  test::RandomLines random(3);
  const Pose pose = turnedPose(40, {1, 0, 1}, {3, 2, 1});
  for (const LineSegment& line : random.anywhere(50, 639, 479)) {
    const Segment3d lifted = backProject(iclCamera(), line, {2.5, 1.5}, false);
    const auto seen = project(iclCamera(), lifted, motionBetween(pose, pose), true);
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(seen->x1, line.x1, 1e-9);
    EXPECT_NEAR(seen->y1, line.y1, 1e-9);
    EXPECT_NEAR(seen->x2, line.x2, 1e-9);
    EXPECT_NEAR(seen->y2, line.y2, 1e-9);
  }
}

TEST(Project, TurnsWhatIsBehindTheCameraAwayOnRequest) {
  const Segment3d behind = {{0, 0, 2}, {1, 1, -2}};
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  EXPECT_FALSE(project(iclCamera(), behind, still, true).has_value());
  const auto mirrored = project(iclCamera(), behind, still, false);
  ASSERT_TRUE(mirrored.has_value());
  EXPECT_NEAR(mirrored->x2, 319.5 - 481.2 / 2, 1e-12);
}

TEST(Project, IsNeverNaN) {
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  EXPECT_FALSE(project(iclCamera(), {{0, 0, 0}, {1, 1, 1}}, still, false).has_value());
  const auto infinite = project(iclCamera(), {{1, 1, 0}, {1, 1, 1}}, still, false);
  ASSERT_TRUE(infinite.has_value());
  EXPECT_TRUE(std::isinf(infinite->x1));
  EXPECT_FALSE(project(iclCamera(), {{1, 1, 0}, {1, 1, 1}}, still, true).has_value());
}

}  // namespace
}  // namespace evolin
