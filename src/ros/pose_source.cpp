// tf2 refuses names with a leading slash; TUM's bags have them.
#include "pose_source.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <utility>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

/// Long enough for a detector that lags behind the bag.
constexpr double kCacheSeconds = 120;

/// Publishers of one tree disagree by less.
constexpr Stamp kJump = 2 * kNanosecondsPerSecond;

template <class Message>
bool isA(const topic_tools::ShapeShifter& message) {
  return message.getDataType() == ros::message_traits::DataType<Message>::value();
}

template <class Message>
StampedPose poseWithCovariance(const topic_tools::ShapeShifter& message) {
  const auto value = message.instantiate<Message>();
  const ros::Time& stamp = value->header.stamp;
  return {fromRos(stamp), fromMessage(value->pose.pose, stamp)};
}

}  // namespace

StampedPose poseFromAny(const topic_tools::ShapeShifter& message) {
  if (isA<geometry_msgs::PoseStamped>(message)) {
    const auto value = message.instantiate<geometry_msgs::PoseStamped>();
    return {fromRos(value->header.stamp), fromMessage(*value)};
  }
  if (isA<nav_msgs::Odometry>(message)) {
    return poseWithCovariance<nav_msgs::Odometry>(message);
  }
  if (isA<geometry_msgs::PoseWithCovarianceStamped>(message)) {
    return poseWithCovariance<geometry_msgs::PoseWithCovarianceStamped>(message);
  }
  throw Error("pose message of type " + quote(message.getDataType()) +
              ", expected geometry_msgs/PoseStamped, geometry_msgs/PoseWithCovarianceStamped or "
              "nav_msgs/Odometry");
}

TfPoses::TfPoses(const std::string& world_frame)
    : world_frame_(withoutLeadingSlash(world_frame)), buffer_(ros::Duration(kCacheSeconds)) {}

std::vector<StampedPose> TfPoses::add(const tf2_msgs::TFMessage& message, bool is_static) {
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    transform.header.frame_id = withoutLeadingSlash(transform.header.frame_id);
    transform.child_frame_id = withoutLeadingSlash(transform.child_frame_id);
    const Stamp stamp = fromRos(transform.header.stamp);
    if (!is_static) {
      if (newest_ && stamp < *newest_ - kJump) {
        buffer_.clear();
        pending_.clear();
        answered_.reset();
        newest_.reset();
      }
      newest_ = std::max(stamp, newest_.value_or(stamp));
    }
    buffer_.setTransform(transform, "evolin_ros", is_static);
  }
  return answer();
}

std::vector<StampedPose> TfPoses::ask(Stamp stamp, const std::string& camera_frame) {
  if (camera_frame.empty() || (answered_ && stamp <= *answered_)) {
    return {};
  }
  pending_.emplace(stamp, withoutLeadingSlash(camera_frame));
  if (pending_.size() > kMostPending) {
    pending_.erase(pending_.begin());
  }
  return answer();
}

std::string TfPoses::whyWaiting() const {
  if (pending_.empty()) {
    return {};
  }
  std::string error;
  const auto& [stamp, camera_frame] = *pending_.begin();
  buffer_.canTransform(world_frame_, camera_frame, toRosTime(stamp), &error);
  return error;
}

TfPoses::Answer TfPoses::lookUp(Stamp stamp, const std::string& camera_frame, Pose* pose) const {
  try {
    const geometry_msgs::TransformStamped found =
        buffer_.lookupTransform(world_frame_, camera_frame, toRosTime(stamp));
    const geometry_msgs::Transform& transform = found.transform;
    geometry_msgs::Pose message;
    message.position.x = transform.translation.x;
    message.position.y = transform.translation.y;
    message.position.z = transform.translation.z;
    message.orientation = transform.rotation;
    *pose = fromMessage(message, found.header.stamp);
    return Answer::kPose;
  } catch (const Error&) {
    return Answer::kNever;  // a transform that is not finite
  } catch (const tf2::TransformException&) {
    // Not known: the newest time at which it is tells whether to wait.
  }
  try {
    const geometry_msgs::TransformStamped latest =
        buffer_.lookupTransform(world_frame_, camera_frame, ros::Time(0));
    return fromRos(latest.header.stamp) >= stamp ? Answer::kNever : Answer::kNotYet;
  } catch (const tf2::TransformException&) {
    return Answer::kNotYet;
  }
}

std::vector<StampedPose> TfPoses::answer() {
  std::vector<StampedPose> poses;
  while (!pending_.empty()) {
    const auto& [stamp, camera_frame] = *pending_.begin();
    Pose pose;
    const Answer found = lookUp(stamp, camera_frame, &pose);
    if (found == Answer::kNotYet) {
      break;
    }
    if (found == Answer::kPose) {
      poses.push_back({stamp, pose});
    }
    answered_ = stamp;
    pending_.erase(pending_.begin());
  }
  return poses;
}

}  // namespace evolin::ros_shell
