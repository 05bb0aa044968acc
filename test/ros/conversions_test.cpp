// Lines, matches, cameras and poses to messages and back, over the wire too.
#include "conversions.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin::ros_shell {
namespace {

using test::expectError;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Stamp kLastStamp = Stamp{4294967295} * kNanosecondsPerSecond + 999999999;

/// What a subscriber in another process gets.
template <typename Message>
Message overTheWire(const Message& message) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  Message result;
  ros::serialization::deserializeMessage(bytes, result);
  return result;
}

/// Bit patterns tell one NaN from another and -0 from 0.
template <typename Number>
void expectSameBits(Number a, Number b) {
  const auto bits = [](Number value) {
    std::array<unsigned char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
  };
  EXPECT_EQ(bits(a), bits(b)) << a << " and " << b;
}

void expectSame(const LineSet& a, const LineSet& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.frame_id, b.frame_id);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.scored, b.scored);
  EXPECT_NEAR(a.processing_time, b.processing_time, 1e-9);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    expectSameBits(a.lines[i].x1, b.lines[i].x1);
    expectSameBits(a.lines[i].y1, b.lines[i].y1);
    expectSameBits(a.lines[i].x2, b.lines[i].x2);
    expectSameBits(a.lines[i].y2, b.lines[i].y2);
    expectSameBits(a.lines[i].score, b.lines[i].score);
    EXPECT_EQ(a.lines[i].id, b.lines[i].id);
  }
}

void expectRoundTrip(const LineSet& set) {
  expectSame(fromMessage(toMessage(set)), set);
  expectSame(fromMessage(overTheWire(toMessage(set))), set);
}

void expectRoundTrip(const MatchSet& set) {
  for (const MatchSet& back :
       {fromMessage(toMessage(set)), fromMessage(overTheWire(toMessage(set)))}) {
    EXPECT_EQ(back.first_stamp, set.first_stamp);
    EXPECT_EQ(back.stamp, set.stamp);
    EXPECT_EQ(back.frame_id, set.frame_id);
    EXPECT_EQ(back.source, set.source);
    EXPECT_EQ(back.lines_source, set.lines_source);
    EXPECT_NEAR(back.processing_time, set.processing_time, 1e-9);
    ASSERT_EQ(back.matches.size(), set.matches.size());
    for (std::size_t i = 0; i < set.matches.size(); ++i) {
      EXPECT_EQ(back.matches[i].first, set.matches[i].first);
      EXPECT_EQ(back.matches[i].second, set.matches[i].second);
      expectSameBits(back.matches[i].distance, set.matches[i].distance);
    }
  }
}

TEST(Stamps, GoThroughAtBothEndsOfRosTime) {
  for (const Stamp stamp : {Stamp{0}, Stamp{1}, Stamp{999999999}, Stamp{1000000000},
                            Stamp{1305031453359684123}, kLastStamp - 1, kLastStamp}) {
    EXPECT_EQ(fromRos(toRosTime(stamp)), stamp);
  }
  EXPECT_EQ(toRosTime(kLastStamp), ros::TIME_MAX);
  EXPECT_EQ(fromRos(ros::Time(7, 8)), 7 * kNanosecondsPerSecond + 8);
}

TEST(Stamps, OutsideOfRosTimeAreRefusedByValue) {
  expectError([] { toRosTime(-1); }, {"-0.000000001", "0 to 4294967295.999999999"});
  expectError([] { toRosTime(kLastStamp + 1); }, {"4294967296.000000"});
  expectError([] { toRosTime(std::numeric_limits<Stamp>::max()); }, {"9223372036.854775807"});
  expectError([] { toRosTime(std::numeric_limits<Stamp>::min()); }, {"-9223372036.854775808"});
}

TEST(LineArrays, GoThroughWithEveryField) {
  LineSet set;
  set.stamp = 1305031453359684123;
  set.frame_id = "camera_optical_frame";
  set.source = "opencv_lsd";
  set.width = 640;
  set.height = 480;
  set.scored = true;
  set.processing_time = 0.012345678;
  set.lines.resize(2);
  set.lines[0] = {1.5, -2.25, 639.0001, 1e-300, 17.25, std::numeric_limits<std::int64_t>::max()};
  expectRoundTrip(set);
  set.lines.clear();
  expectRoundTrip(set);
  expectRoundTrip(LineSet());
  set.stamp = kLastStamp;
  expectRoundTrip(set);
}

TEST(LineArrays, KeepTheBitsOfWhatIsNotFinite) {
  const double payload = std::nan("0x1234");
  const double odd[] = {kNan,
                        -kNan,
                        payload,
                        kInfinity,
                        -kInfinity,
                        -0.0,
                        std::numeric_limits<double>::denorm_min(),
                        std::numeric_limits<double>::max(),
                        std::numeric_limits<double>::lowest()};
  LineSet set;
  for (const double value : odd) {
    set.lines.push_back({value, 1, 2, 3, 4, 5});
    set.lines.push_back({1, value, value, value, value, std::numeric_limits<std::int64_t>::min()});
  }
  expectRoundTrip(set);
}

TEST(LineArrays, OfAHundredThousandLinesGoThrough) {
  test::RandomLines random(1);
  LineSet set;
  set.lines = random.anywhere(100000, 640, 480);
  for (LineSegment& line : set.lines) {
    line.score = random.uniform(-5, 5);
    line.id = static_cast<std::int64_t>(random.index(1000));
  }
  expectRoundTrip(set);
}

TEST(LineArrays, LoseALeadingSlashOfTheFrame) {
  evolin_ros::LineArray message;
  message.header.frame_id = "/openni_rgb_optical_frame";
  EXPECT_EQ(fromMessage(message).frame_id, "openni_rgb_optical_frame");
  evolin_ros::LineMatchArray matches;
  matches.header.frame_id = "/a/b";
  EXPECT_EQ(fromMessage(matches).frame_id, "a/b");
  EXPECT_EQ(withoutLeadingSlash(""), "");
  EXPECT_EQ(withoutLeadingSlash("/"), "");
  EXPECT_EQ(withoutLeadingSlash("map"), "map");
}

TEST(LineArrays, RefuseTimesThatRosCannotHold) {
  for (const double seconds : {kNan, kInfinity, -kInfinity, 1e10, -1e10}) {
    LineSet lines;
    lines.processing_time = seconds;
    expectError([&] { toMessage(lines); }, {"processing time"});
    MatchSet matches;
    matches.processing_time = seconds;
    expectError([&] { toMessage(matches); }, {"processing time"});
  }
  LineSet before_1970;
  before_1970.stamp = -5;
  expectError([&] { toMessage(before_1970); }, {"-0.000000005"});
  MatchSet first_before_1970;
  first_before_1970.first_stamp = -5;
  expectError([&] { toMessage(first_before_1970); }, {"-0.000000005"});
}

TEST(LineMatchArrays, GoThroughWithEveryField) {
  MatchSet set;
  set.first_stamp = 3;
  set.stamp = kLastStamp;
  set.frame_id = "camera";
  set.source = "lbd";
  set.lines_source = "ground_truth";
  set.processing_time = 1.5;
  expectRoundTrip(set);
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  set.matches = {{0, 1, 0.5F}, {kMost, 0, nan}, {1, kMost, -nan}, {2, 2, infinity}, {3, 3, -0.0F}};
  expectRoundTrip(set);
  set.matches.clear();
  for (std::uint32_t i = 0; i < 100000; ++i) {
    set.matches.push_back({i, 100000 - i, static_cast<float>(i) / 7});
  }
  expectRoundTrip(set);
}

Camera sampleCamera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 481.2;
  camera.fy = -480.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

void expectSame(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.distortion_model, b.distortion_model);
}

TEST(CameraInfo, GoesThrough) {
  std_msgs::Header header;
  header.stamp = ros::Time(4, 5);
  header.frame_id = "camera";
  const sensor_msgs::CameraInfo message = toMessage(sampleCamera(), header);
  EXPECT_EQ(message.header.stamp, header.stamp);
  EXPECT_EQ(message.header.frame_id, "camera");
  EXPECT_EQ(message.D, std::vector<double>(5, 0.0)) << "plumb_bob has five coefficients";
  EXPECT_EQ(message.P[0], 481.2);
  EXPECT_EQ(message.P[5], -480.0);
  EXPECT_EQ(message.P[6], 239.5);
  EXPECT_EQ(message.P[10], 1);
  EXPECT_EQ(message.R[0] + message.R[4] + message.R[8], 3);
  expectSame(fromMessage(overTheWire(message)), sampleCamera());

  Camera distorted = sampleCamera();
  distorted.distortion_model = "equidistant";
  distorted.distortion = {0.1, -0.2, 0.3, -0.4};
  const Camera back = fromMessage(overTheWire(toMessage(distorted, header)));
  expectSame(back, distorted);
  EXPECT_EQ(back.distortion, distorted.distortion);
}

TEST(CameraInfo, OfAnUncalibratedCameraIsRefused) {
  sensor_msgs::CameraInfo message = toMessage(sampleCamera(), std_msgs::Header());
  message.K[0] = 0;
  expectError([&] { fromMessage(message); }, {"K[0] is 0", "uncalibrated"});
  expectError([] { fromMessage(sensor_msgs::CameraInfo()); }, {"uncalibrated"});
}

TEST(CameraInfo, IsCheckedLikeACameraFile) {
  sensor_msgs::CameraInfo message = toMessage(sampleCamera(), std_msgs::Header());
  message.distortion_model = "fisheye62";
  expectError([&] { fromMessage(message); }, {"camera_info", "fisheye62", "equidistant"});
  message = toMessage(sampleCamera(), std_msgs::Header());
  message.K[4] = kNan;
  expectError([&] { fromMessage(message); }, {"camera_info", "fy"});
  message = toMessage(sampleCamera(), std_msgs::Header());
  message.width = 0;
  expectError([&] { fromMessage(message); }, {"camera_info", "0 x 480"});
  message.width = std::numeric_limits<std::uint32_t>::max();
  expectError([&] { fromMessage(message); }, {"camera_info"});
  message = toMessage(sampleCamera(), std_msgs::Header());
  message.distortion_model.clear();
  message.D.clear();
  EXPECT_EQ(fromMessage(message).distortion_model, "plumb_bob");
}

TEST(CameraInfo, AppliesRegionOfInterestAndBinning) {
  sensor_msgs::CameraInfo message = toMessage(sampleCamera(), std_msgs::Header());
  message.roi.x_offset = 100;
  message.roi.y_offset = 40;
  message.roi.width = 320;
  message.roi.height = 240;
  message.binning_x = 2;
  message.binning_y = 4;
  const Camera camera = fromMessage(message);
  EXPECT_EQ(camera.width, 160);
  EXPECT_EQ(camera.height, 60);
  EXPECT_DOUBLE_EQ(camera.fx, 240.6);
  EXPECT_DOUBLE_EQ(camera.fy, -120);
  EXPECT_DOUBLE_EQ(camera.cx, 109.75);
  EXPECT_DOUBLE_EQ(camera.cy, 49.875);
  message.binning_x = 1000;
  expectError([&] { fromMessage(message); }, {"0 x 60"});
}

TEST(Poses, GoThrough) {
  test::RandomLines random(3);
  for (int i = 0; i < 200; ++i) {
    Pose pose;
    pose.translation = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    pose.rotation = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                     random.uniform(-1, 1)};
    pose.rotation.normalize();
    geometry_msgs::PoseStamped message;
    message.pose = toMessage(pose);
    const Pose back = fromMessage(overTheWire(message));
    EXPECT_EQ(back.translation, pose.translation);
    EXPECT_LT((back.rotation.coeffs() - pose.rotation.coeffs()).norm(), 1e-15);
  }
}

TEST(Poses, AreNormalisedAndRefusedWithoutARotation) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = ros::Time(7, 0);
  message.pose.orientation.w = 2;
  EXPECT_EQ(fromMessage(message).rotation.w(), 1);
  message.pose.orientation.w = 0;
  expectError([&] { fromMessage(message); }, {"7.000000", "norm 0"});
  for (const double bad : {kNan, kInfinity}) {
    message.pose.orientation.w = bad;
    expectError([&] { fromMessage(message); }, {"7.000000", "quaternion"});
    message.pose.orientation.w = 1;
    message.pose.position.y = bad;
    expectError([&] { fromMessage(message); }, {"7.000000", "position"});
    message.pose.position.y = 0;
  }
}

}  // namespace
}  // namespace evolin::ros_shell
