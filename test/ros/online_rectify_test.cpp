// A camera with distortion in front of a detector: rectified, refused or taken as it is.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <ros/param.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "conversions.h"
#include "online_stream.h"

namespace evolin::test {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// 640x480 with barrel distortion, as a calibration leaves it.
sensor_msgs::CameraInfo distortedCamera(const std::string& model = "plumb_bob") {
  sensor_msgs::CameraInfo info;
  info.width = kWidth;
  info.height = kHeight;
  info.distortion_model = model;
  info.D = model == "plumb_bob" ? std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0}
                                : std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0, 0.01, 0.02, 0};
  info.K = {500, 0, 320.5, 0, 505, 238, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {515, 0, 322, 0, 0, 520, 236, 0, 0, 0, 1, 0};
  return info;
}

/// Where the camera without distortion, P, has a straight line, and the raw image of it: white
/// above the line and black below.
struct Scene {
  cv::Point2d left = {60, 60};
  cv::Point2d right = {580, 40};
  cv::Mat raw;
};

Scene makeScene(const sensor_msgs::CameraInfo& info) {
  Scene scene;
  const cv::Mat k = cv::Mat(3, 3, CV_64F, const_cast<double*>(info.K.data())).clone();
  const cv::Mat d(info.D, true);
  // Each raw pixel looks along a ray, which P maps to the rectified image.
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      pixels.emplace_back(x, y);
    }
  }
  std::vector<cv::Point2d> rays;
  cv::undistortPoints(pixels, rays, k, d);
  scene.raw.create(kHeight, kWidth, CV_8UC1);
  const double slope = (scene.right.y - scene.left.y) / (scene.right.x - scene.left.x);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double x = info.P[0] * rays[i].x + info.P[2];
    const double y = info.P[5] * rays[i].y + info.P[6];
    const double below = y - (scene.left.y + slope * (x - scene.left.x));
    scene.raw.data[i] = cv::saturate_cast<std::uint8_t>(127.5 - 127.5 * std::clamp(below, -1., 1.));
  }
  return scene;
}

/// What the lines of at least 30 pixels are like: how much of the scene's width they span, and how
/// far their ends are at most from the scene's line, in pixels.
struct Found {
  double span = 0;
  double off = 0;
};

Found compare(const evolin_ros::LineArray& lines, cv::Point2d left, cv::Point2d right) {
  Found found;
  double first = 1e9;
  double last = -1e9;
  const cv::Point2d along = right - left;
  for (const evolin_ros::Line& line : lines.lines) {
    if (std::hypot(line.x2 - line.x1, line.y2 - line.y1) < 30) {
      continue;
    }
    for (const cv::Point2d& end : {cv::Point2d(line.x1, line.y1), cv::Point2d(line.x2, line.y2)}) {
      found.off = std::max(found.off, std::abs(along.cross(end - left)) / cv::norm(along));
      first = std::min(first, end.x);
      last = std::max(last, end.x);
    }
  }
  found.span = last - first;
  return found;
}

class OnlineRectify : public ::testing::Test {
 protected:
  OnlineRectify() : manager_(testNamespace()), lines_(manager_.space() + "/lines") {
    ros::NodeHandle handle(manager_.space());
    image_ = handle.advertise<sensor_msgs::Image>("image", 10);
    camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 10);
    ros::param::set(node_ + "/detector", "hough_p");
    ros::param::set(node_ + "/parameters/max_gap", 20);
  }

  void load(const std::string& rectify, unsigned camera_listeners) {
    ros::param::set(node_ + "/rectify", rectify);
    ASSERT_TRUE(loadDetector(&manager_));
    ASSERT_TRUE(waitFor("the detector", [&] {
      return image_.getNumSubscribers() == 1 &&
             camera_info_.getNumSubscribers() == camera_listeners;
    }));
  }

  void send(const cv::Mat& image, const sensor_msgs::CameraInfo& info) {
    std_msgs::Header header;
    header.stamp = ros::Time(1000 + ++sent_);
    header.frame_id = "camera";
    sensor_msgs::CameraInfo message = info;
    message.header = header;
    // In this order, as many drivers have it.
    image_.publish(
        cv_bridge::CvImage(header, sensor_msgs::image_encodings::MONO8, image).toImageMsg());
    camera_info_.publish(message);
  }

  evolin_ros::LineArray detect(const cv::Mat& image, const sensor_msgs::CameraInfo& info) {
    const std::size_t count = lines_.count();
    send(image, info);
    EXPECT_TRUE(lines_.waitForCount(count + 1));
    return lines_.count() > count ? lines_.messages().back() : evolin_ros::LineArray();
  }

  /// An image may overtake its camera; the camera holds for those that follow.
  void expectLinesSoon(const cv::Mat& image, const sensor_msgs::CameraInfo& info) {
    EXPECT_TRUE(waitFor("lines under another camera", [&] {
      send(image, info);
      return lines_.count() > 0;
    }));
  }

  Manager manager_;
  Collector<evolin_ros::LineArray> lines_;
  ros::Publisher image_;
  ros::Publisher camera_info_;
  std::uint32_t sent_ = 0;
  const std::string node_ = testNamespace() + "/detector";
};

TEST_F(OnlineRectify, LinesOfARectifiedImageAreStraightAndWhereTheCameraWithoutDistortionHasThem) {
  load("true", 1);
  for (const char* model : {"plumb_bob", "rational_polynomial"}) {
    SCOPED_TRACE(model);
    const sensor_msgs::CameraInfo info = distortedCamera(model);
    const Scene scene = makeScene(info);
    const evolin_ros::LineArray lines = detect(scene.raw, info);
    const Found found = compare(lines, scene.left, scene.right);
    EXPECT_GT(found.span, 500);
    EXPECT_LT(found.off, 2.5);
    EXPECT_EQ(lines.width, 640U);
    EXPECT_EQ(lines.source.rfind("hough_p#", 0), 0U);
  }
}

TEST_F(OnlineRectify, TakenAsItIsTheLineIsBent) {
  load("false", 0);
  const sensor_msgs::CameraInfo info = distortedCamera();
  const Scene scene = makeScene(info);
  EXPECT_GT(compare(detect(scene.raw, info), scene.left, scene.right).off, 8);
}

TEST_F(OnlineRectify, RegionOfInterestAndBinningAreThoseOfTheImage) {
  load("true", 1);
  sensor_msgs::CameraInfo info = distortedCamera();
  const Scene scene = makeScene(info);
  // The upper half, every second pixel.
  info.roi.x_offset = 40;
  info.roi.y_offset = 0;
  info.roi.width = 560;
  info.roi.height = 240;
  info.binning_x = 2;
  info.binning_y = 2;
  cv::Mat cut;
  cv::resize(scene.raw(cv::Rect(40, 0, 560, 240)), cut, cv::Size(280, 120), 0, 0,
             cv::INTER_NEAREST);
  const evolin_ros::LineArray lines = detect(cut, info);
  EXPECT_EQ(lines.width, 280U);
  const cv::Point2d offset(40, 0);
  const Found found = compare(lines, (scene.left - offset) * 0.5, (scene.right - offset) * 0.5);
  EXPECT_GT(found.span, 220);
  EXPECT_LT(found.off, 2.5);
}

TEST_F(OnlineRectify, DistortionIsRefusedWhereAskedFor) {
  const LogReader log;
  load("refuse", 1);
  sensor_msgs::CameraInfo info = distortedCamera();
  const Scene scene = makeScene(info);
  send(scene.raw, info);
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"has distortion (plumb_bob)", "~rectify"}));
  EXPECT_EQ(lines_.count(), 0U);
  info.D.assign(5, 0.0);
  expectLinesSoon(scene.raw, info);
}

TEST_F(OnlineRectify, AnUncalibratedCameraIsToldOnce) {
  const LogReader log;
  load("true", 1);
  sensor_msgs::CameraInfo info = distortedCamera();
  const Scene scene = makeScene(info);
  info.K.assign(0);
  info.P.assign(0);
  for (int i = 0; i < 3; ++i) {
    send(scene.raw, info);
  }
  EXPECT_TRUE(
      log.waitFor(rosgraph_msgs::Log::ERROR, {"~rectify needs the camera", "uncalibrated"}));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"camera_info: K[0] is 0"}));
  expectLinesSoon(scene.raw, distortedCamera());
  std::size_t warnings = 0;
  for (const std::string& text : log.find(rosgraph_msgs::Log::WARN, {"K[0] is 0"})) {
    warnings += text.find("~rectify") == std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(warnings, 1U);
}

TEST_F(OnlineRectify, ACameraOfAnotherSizeIsNamed) {
  const LogReader log;
  load("true", 1);
  const sensor_msgs::CameraInfo info = distortedCamera();
  send(cv::Mat(120, 160, CV_8UC1, cv::Scalar(90)), info);
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"160x120", "640x480"}));
}

}  // namespace
}  // namespace evolin::test
