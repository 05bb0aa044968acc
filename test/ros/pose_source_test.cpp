// Poses out of messages of several types and out of tf's tree, slashes and jumps included.
#include "pose_source.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>

#include <limits>

#include "conversions.h"
#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

template <class Message>
topic_tools::ShapeShifter shapeOf(const Message& message) {
  topic_tools::ShapeShifter shape;
  shape.morph(ros::message_traits::md5sum<Message>(message),
              ros::message_traits::datatype<Message>(message),
              ros::message_traits::definition<Message>(message), "");
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  ros::serialization::IStream stream(bytes.message_start,
                                     static_cast<std::uint32_t>(bytes.num_bytes - 4));
  shape.read(stream);
  return shape;
}

geometry_msgs::Pose oneToTheRight() {
  geometry_msgs::Pose pose;
  pose.position.x = 1;
  pose.orientation.w = 1;
  return pose;
}

TEST(PoseFromAny, TakesThreeTypesAndNamesOthers) {
  geometry_msgs::PoseStamped stamped;
  stamped.header.stamp = ros::Time(3, 5);
  stamped.pose = oneToTheRight();
  geometry_msgs::PoseWithCovarianceStamped with_covariance;
  with_covariance.header = stamped.header;
  with_covariance.pose.pose = stamped.pose;
  nav_msgs::Odometry odometry;
  odometry.header = stamped.header;
  odometry.pose.pose = stamped.pose;
  for (const topic_tools::ShapeShifter& shape :
       {shapeOf(stamped), shapeOf(with_covariance), shapeOf(odometry)}) {
    const StampedPose pose = poseFromAny(shape);
    EXPECT_EQ(pose.stamp, 3000000005) << shape.getDataType();
    EXPECT_EQ(pose.pose.translation, Eigen::Vector3d(1, 0, 0)) << shape.getDataType();
  }
  test::expectError([] { poseFromAny(shapeOf(geometry_msgs::TwistStamped())); },
                    {"geometry_msgs/TwistStamped", "nav_msgs/Odometry"});
}

tf2_msgs::TFMessage transform(const std::string& parent, const std::string& child, double seconds,
                              double x) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  message.transforms[0].header.stamp = ros::Time(seconds);
  message.transforms[0].transform.translation.x = x;
  message.transforms[0].transform.rotation.w = 1;
  return message;
}

Stamp at(double seconds) { return fromSeconds(seconds); }

TEST(TfPoses, LooksUpAChainWithSlashesAsSoonAsItIsKnown) {
  TfPoses poses("/world");
  EXPECT_TRUE(poses.add(transform("/kinect", "/camera", 0, 10), true).empty());
  EXPECT_TRUE(poses.add(transform("/world", "/kinect", 1, 0), false).empty());
  EXPECT_TRUE(poses.ask(at(1.5), "/camera").empty()) << "the future is not known";
  EXPECT_NE(poses.whyWaiting(), "");
  const std::vector<StampedPose> found = poses.add(transform("/world", "/kinect", 2, 1), false);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].stamp, at(1.5));
  EXPECT_NEAR(found[0].pose.translation.x(), 10.5, 1e-9);
  EXPECT_EQ(poses.whyWaiting(), "");
  EXPECT_TRUE(poses.ask(at(1.5), "camera").empty()) << "answered once";
  ASSERT_EQ(poses.ask(at(1.75), "camera").size(), 1U);
}

TEST(TfPoses, PassesOverWhatWasBeforeTheTree) {
  TfPoses poses("world");
  EXPECT_TRUE(poses.ask(at(0.5), "camera").empty());
  EXPECT_TRUE(poses.ask(at(1.5), "camera").empty());
  EXPECT_TRUE(poses.add(transform("world", "camera", 1, 0), false).empty());
  const std::vector<StampedPose> found = poses.add(transform("world", "camera", 2, 2), false);
  ASSERT_EQ(found.size(), 1U) << "0.5 s will never be known";
  EXPECT_EQ(found[0].stamp, at(1.5));
  EXPECT_NEAR(found[0].pose.translation.x(), 1, 1e-9);
}

TEST(TfPoses, AJumpBackBeginsAnew) {
  TfPoses poses("world");
  for (const double seconds : {1.0, 2.0, 3.0, 4.0}) {
    poses.add(transform("world", "camera", seconds, seconds), false);
  }
  ASSERT_EQ(poses.ask(at(3.5), "camera").size(), 1U);
  poses.add(transform("world", "camera", 1, 100), false);
  EXPECT_TRUE(poses.ask(at(1.5), "camera").empty());
  const std::vector<StampedPose> found = poses.add(transform("world", "camera", 2, 100), false);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].pose.translation.x(), 100, 1e-9) << "not the first pass's 1.5";
}

TEST(TfPoses, ATransformThatIsNotFiniteGivesNoPose) {
  TfPoses poses("world");
  poses.add(transform("world", "camera", 1, std::numeric_limits<double>::infinity()), false);
  poses.add(transform("world", "camera", 2, std::numeric_limits<double>::infinity()), false);
  EXPECT_TRUE(poses.ask(at(1.5), "camera").empty());
  EXPECT_EQ(poses.pending(), 0U) << "it will never be known";
}

TEST(TfPoses, TheFirstFrameAskedForCountsAndANewPassAsksAgain) {
  TfPoses poses("world");
  poses.ask(at(1.5), "camera");
  poses.ask(at(1.5), "elsewhere");
  poses.add(transform("world", "camera", 1, 0), false);
  ASSERT_EQ(poses.add(transform("world", "camera", 2, 1), false).size(), 1U);
  EXPECT_TRUE(poses.ask(at(1.5), "camera").empty());
  poses.startPass();
  EXPECT_EQ(poses.ask(at(1.5), "camera").size(), 1U);
}

TEST(TfPoses, AFrameWithoutNameIsPassedOver) {
  TfPoses poses("world");
  EXPECT_TRUE(poses.ask(at(1), "").empty());
  EXPECT_EQ(poses.whyWaiting(), "");
}

}  // namespace
}  // namespace evolin::ros_shell
