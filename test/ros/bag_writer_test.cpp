// Frames written as a bag and read back, field by field.
#include "bag_writer.h"

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <opencv2/core.hpp>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"
#include "topics.h"

namespace evolin {
namespace {

namespace names = ros_shell::bag_topics;
using test::expectError;

constexpr Stamp kStart = 1305031453359684123;
constexpr Stamp kStep = 33333333;
constexpr Stamp kDepthLag = 5000000;

/// Number `i` of a sequence in which everything differs from frame to frame. Even frames are
/// colour, odd ones grey; frame 2 has neither depth nor pose nor ground truth nor camera; frame 3
/// has an annotation without lines.
SequenceFrame sampleFrame(int i) {
  SequenceFrame result;
  Frame& frame = result.frame;
  frame.stamp = kStart + i * kStep;
  frame.image = cv::Mat(24, 32, i % 2 == 0 ? CV_8UC3 : CV_8UC1);
  cv::randu(frame.image, 0, 256);
  if (i == 2) return result;
  frame.depth = cv::Mat(24, 32, CV_32FC1);
  cv::randu(frame.depth, 0.5, 4);
  frame.depth.at<float>(3, 5) = std::numeric_limits<float>::quiet_NaN();
  if (i != 1) result.depth_stamp = frame.stamp + kDepthLag;
  Camera camera;
  camera.width = 32;
  camera.height = 24;
  camera.fx = 30 + i;
  camera.fy = -31 - i;
  camera.cx = 15.5;
  camera.cy = 11.5;
  frame.camera = camera;
  Pose pose;
  pose.translation = {1.0 + i, -2.0, 0.125};
  pose.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  frame.pose = pose;
  LineSegments lines;
  if (i != 3) {
    lines = {{1, 2, 30.25, 20.5, i == 1 ? 0.75 : kNoScore, 7 + i}, {3, 4, 5, 6, 0.5, kNoId}};
  }
  result.ground_truth = lines;
  return result;
}

/// All messages of one topic by stamp; checks that the bag's time is the header's.
template <typename Message>
std::map<Stamp, boost::shared_ptr<Message>> messagesOf(const rosbag::Bag& bag,
                                                       const std::string& topic) {
  std::map<Stamp, boost::shared_ptr<Message>> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto message = instance.instantiate<Message>();
    if (!message) {
      ADD_FAILURE() << topic << " is of type " << instance.getDataType();
      continue;
    }
    const Stamp stamp = ros_shell::fromRos(instance.getTime());
    EXPECT_TRUE(messages.emplace(stamp, message).second) << "two messages at one time on " << topic;
  }
  return messages;
}

void expectImage(const sensor_msgs::Image& message, const cv::Mat& image,
                 const std::string& encoding) {
  EXPECT_EQ(message.encoding, encoding);
  ASSERT_EQ(message.width, static_cast<std::uint32_t>(image.cols));
  ASSERT_EQ(message.height, static_cast<std::uint32_t>(image.rows));
  ASSERT_EQ(message.step, image.cols * image.elemSize());
  ASSERT_EQ(message.data.size(), message.step * message.height);
  for (int row = 0; row < image.rows; ++row) {
    EXPECT_EQ(std::memcmp(&message.data[static_cast<std::size_t>(row) * message.step],
                          image.ptr(row), message.step),
              0)
        << "row " << row;
  }
}

class BagOfFour : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 4; ++i) frames_.push_back(sampleFrame(i));
    const std::filesystem::path file = folder_.path() / "four.bag";
    BagWriter writer(file);
    for (const SequenceFrame& frame : frames_) writer.add(frame);
    writer.close();
    bag_.open(file.string(), rosbag::bagmode::Read);
  }

  const Frame& frame(int i) const { return frames_[static_cast<std::size_t>(i)].frame; }

  test::TemporaryFolder folder_;
  std::vector<SequenceFrame> frames_;
  rosbag::Bag bag_;
};

/// Whether the running numbers are 0, 1, 2, ... in order of time.
template <typename Message, typename Header>
void expectNumbered(const rosbag::Bag& bag, const std::string& topic, const Header& header_of) {
  SCOPED_TRACE(topic);
  std::uint32_t number = 0;
  for (const auto& [stamp, message] : messagesOf<Message>(bag, topic)) {
    EXPECT_EQ(header_of(*message).seq, number++);
  }
  EXPECT_GE(number, 2U);
}

TEST_F(BagOfFour, NumbersTheMessagesOfEachTopic) {
  const auto header = [](const auto& message) { return message.header; };
  expectNumbered<sensor_msgs::Image>(bag_, names::kImage, header);
  expectNumbered<sensor_msgs::CameraInfo>(bag_, names::kCameraInfo, header);
  expectNumbered<sensor_msgs::Image>(bag_, names::kDepth, header);
  expectNumbered<evolin_ros::LineArray>(bag_, names::kGroundTruthLines, header);
  expectNumbered<geometry_msgs::PoseStamped>(bag_, names::kGroundTruthPose, header);
  expectNumbered<tf2_msgs::TFMessage>(
      bag_, names::kTf, [](const auto& message) { return message.transforms.at(0).header; });
}

TEST_F(BagOfFour, HoldsEveryImageBitByBit) {
  const auto images = messagesOf<sensor_msgs::Image>(bag_, names::kImage);
  ASSERT_EQ(images.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const sensor_msgs::Image& message = *images.at(frame(i).stamp);
    EXPECT_EQ(ros_shell::fromRos(message.header.stamp), frame(i).stamp);
    EXPECT_EQ(message.header.frame_id, names::kCameraFrame);
    expectImage(message, frame(i).image, i % 2 == 0 ? "bgr8" : "mono8");
  }
}

TEST_F(BagOfFour, HoldsDepthAtItsOwnStamp) {
  const auto depths = messagesOf<sensor_msgs::Image>(bag_, names::kDepth);
  const auto infos = messagesOf<sensor_msgs::CameraInfo>(bag_, names::kDepthCameraInfo);
  ASSERT_EQ(depths.size(), 3U);
  ASSERT_EQ(infos.size(), 3U);
  for (const int i : {0, 1, 3}) {
    const Stamp stamp = frame(i).stamp + (i == 1 ? 0 : kDepthLag);
    const sensor_msgs::Image& message = *depths.at(stamp);
    EXPECT_EQ(ros_shell::fromRos(message.header.stamp), stamp);
    EXPECT_EQ(message.header.frame_id, names::kCameraFrame);
    expectImage(message, frame(i).depth, "32FC1");
    const cv::Mat back = ros_shell::toDepthMap(depths.at(stamp), 5000).metres();
    EXPECT_TRUE(std::isnan(back.at<float>(3, 5)));
    EXPECT_EQ(back.at<float>(0, 0), frame(i).depth.at<float>(0, 0));
    EXPECT_EQ(infos.at(stamp)->K[0], 30 + i);
  }
}

TEST_F(BagOfFour, HoldsTheCamera) {
  const auto infos = messagesOf<sensor_msgs::CameraInfo>(bag_, names::kCameraInfo);
  ASSERT_EQ(infos.size(), 3U);
  for (const int i : {0, 1, 3}) {
    const sensor_msgs::CameraInfo& message = *infos.at(frame(i).stamp);
    EXPECT_EQ(message.header.frame_id, names::kCameraFrame);
    const Camera camera = ros_shell::fromMessage(message);
    EXPECT_EQ(camera.width, 32);
    EXPECT_EQ(camera.height, 24);
    EXPECT_EQ(camera.fx, 30 + i);
    EXPECT_EQ(camera.fy, -31 - i);
    EXPECT_EQ(camera.cx, 15.5);
    EXPECT_EQ(camera.cy, 11.5);
  }
}

TEST_F(BagOfFour, HoldsThePoseTwice) {
  const auto poses = messagesOf<geometry_msgs::PoseStamped>(bag_, names::kGroundTruthPose);
  const auto transforms = messagesOf<tf2_msgs::TFMessage>(bag_, names::kTf);
  ASSERT_EQ(poses.size(), 3U);
  ASSERT_EQ(transforms.size(), 3U);
  for (const int i : {0, 1, 3}) {
    const geometry_msgs::PoseStamped& stamped = *poses.at(frame(i).stamp);
    EXPECT_EQ(stamped.header.frame_id, names::kWorldFrame);
    const Pose pose = ros_shell::fromMessage(stamped);
    EXPECT_EQ(pose.translation, frame(i).pose->translation);
    EXPECT_EQ(pose.rotation.coeffs(), frame(i).pose->rotation.coeffs());
    ASSERT_EQ(transforms.at(frame(i).stamp)->transforms.size(), 1U);
    const geometry_msgs::TransformStamped& tf = transforms.at(frame(i).stamp)->transforms[0];
    EXPECT_EQ(ros_shell::fromRos(tf.header.stamp), frame(i).stamp);
    EXPECT_EQ(tf.header.frame_id, names::kWorldFrame);
    EXPECT_EQ(tf.child_frame_id, names::kCameraFrame);
    EXPECT_EQ(tf.transform.translation.x, 1.0 + i);
    EXPECT_EQ(tf.transform.translation.y, -2.0);
    EXPECT_EQ(tf.transform.translation.z, 0.125);
    EXPECT_EQ(tf.transform.rotation.w, 0.5);
    EXPECT_EQ(tf.transform.rotation.x, -0.5);
    EXPECT_EQ(tf.transform.rotation.y, 0.5);
    EXPECT_EQ(tf.transform.rotation.z, 0.5);
  }
}

TEST_F(BagOfFour, HoldsAnnotationsWithTheirIds) {
  const auto annotations = messagesOf<evolin_ros::LineArray>(bag_, names::kGroundTruthLines);
  ASSERT_EQ(annotations.size(), 3U) << "a frame without annotation has no message";
  for (const int i : {0, 1, 3}) {
    const LineSet set = ros_shell::fromMessage(*annotations.at(frame(i).stamp));
    EXPECT_EQ(set.stamp, frame(i).stamp);
    EXPECT_EQ(set.frame_id, names::kCameraFrame);
    EXPECT_EQ(set.source, "ground_truth");
    EXPECT_EQ(set.width, 32);
    EXPECT_EQ(set.height, 24);
    EXPECT_EQ(set.scored, i == 1) << "only where every line has a score";
    ASSERT_EQ(set.lines.size(), i == 3 ? 0U : 2U) << "an empty annotation is one";
    if (i == 3) continue;
    EXPECT_EQ(set.lines[0].id, 7 + i);
    EXPECT_EQ(set.lines[0].x1, 1);
    EXPECT_EQ(set.lines[0].y1, 2);
    EXPECT_EQ(set.lines[0].x2, 30.25);
    EXPECT_EQ(set.lines[0].y2, 20.5);
    EXPECT_EQ(set.lines[0].hasScore(), i == 1);
    EXPECT_EQ(set.lines[1].id, kNoId);
    EXPECT_EQ(set.lines[1].score, 0.5);
  }
}

TEST_F(BagOfFour, HoldsNothingElse) {
  rosbag::View view(bag_);
  std::map<std::string, int> topics;
  for (const rosbag::MessageInstance& instance : view) ++topics[instance.getTopic()];
  EXPECT_EQ(topics, (std::map<std::string, int>{{names::kImage, 4},
                                                {names::kCameraInfo, 3},
                                                {names::kDepth, 3},
                                                {names::kDepthCameraInfo, 3},
                                                {names::kTf, 3},
                                                {names::kGroundTruthLines, 3},
                                                {names::kGroundTruthPose, 3}}));
}

TEST(BagWriter, CompressesWithLz4) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "grey.bag";
  SequenceFrame frame = sampleFrame(2);
  frame.frame.image = cv::Mat(480, 640, CV_8UC1, cv::Scalar(7));
  BagWriter writer(file);
  for (int i = 0; i < 10; ++i) {
    frame.frame.stamp += kStep;
    writer.add(frame);
  }
  writer.close();
  EXPECT_LT(std::filesystem::file_size(file), 10U * 640 * 480 / 20);
  rosbag::Bag bag(file.string(), rosbag::bagmode::Read);
  EXPECT_EQ(rosbag::View(bag).size(), 10U);
}

TEST(BagWriter, WritesRowsOfACutOutImage) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "cut.bag";
  cv::Mat large(60, 80, CV_8UC3);
  cv::randu(large, 0, 256);
  SequenceFrame frame = sampleFrame(2);
  frame.frame.image = large(cv::Rect(11, 7, 32, 24));
  ASSERT_FALSE(frame.frame.image.isContinuous());
  BagWriter writer(file);
  writer.add(frame);
  writer.close();
  rosbag::Bag bag(file.string(), rosbag::bagmode::Read);
  const auto images = messagesOf<sensor_msgs::Image>(bag, names::kImage);
  expectImage(*images.at(frame.frame.stamp), frame.frame.image, "bgr8");
}

TEST(BagWriter, RefusesStampsThatABagCannotHold) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.bag";
  BagWriter writer(file);
  SequenceFrame frame = sampleFrame(0);
  frame.frame.stamp = -1;
  expectError([&] { writer.add(frame); }, {"-0.000000001"});
  frame.frame.stamp = 0;
  expectError([&] { writer.add(frame); }, {file.string(), "stamp 0"});
  frame = sampleFrame(0);
  writer.add(frame);
  writer.close();
  rosbag::Bag bag(file.string(), rosbag::bagmode::Read);
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery(names::kImage)).size(), 1U);
}

TEST(BagWriter, NamesAFileThatCannotBeMade) {
  const test::TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing" / "a.bag").string();
  expectError([&] { BagWriter writer(missing); }, {missing, "cannot be written"});
  const std::string is_folder = folder.path().string();
  expectError([&] { BagWriter writer(is_folder); }, {is_folder, "cannot be written"});
}

TEST(BagWriter, NamesTheFileWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full to write to";
  // In a process of its own: an exception out of a destructor would end this one.
  constexpr int kToldOf = 3;
  const auto write_and_tell = [] {
    try {
      BagWriter writer("/dev/full");
      for (int i = 0; i < 1000; ++i) writer.add(sampleFrame(i + 4));
      writer.close();
    } catch (const Error& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(kToldOf);
    }
  };
  EXPECT_EXIT(write_and_tell(), testing::ExitedWithCode(kToldOf), "/dev/full: cannot be");
}

}  // namespace
}  // namespace evolin
