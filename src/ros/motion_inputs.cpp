// A message that cannot be used is named and left out; the frame that lacks it is counted where it
// is scored.
#include "motion_inputs.h"

#include <utility>

#include "conversions.h"
#include "topics.h"

namespace evolin::ros_shell {

MotionInputs::MotionInputs(ros::NodeHandle& handle, const EvaluatorOptions& options,
                           Callbacks callbacks)
    : depth_factor_(options.depth_factor), callbacks_(std::move(callbacks)) {
  depth_ = handle.subscribe<sensor_msgs::Image>(
      topics::kDepth, kImageQueue,
      [this](const sensor_msgs::ImageConstPtr& message) { onDepth(message); });
  if (options.pose_from == EvaluatorOptions::PoseFrom::kTopic) {
    pose_ = handle.subscribe<topic_tools::ShapeShifter>(
        topics::kGroundTruthPose, kResultQueue,
        [this](const topic_tools::ShapeShifter::ConstPtr& message) { onPose(message); });
    return;
  }
  tf_ = std::make_unique<TfPoses>(options.world_frame);
  tf_static_ = handle.subscribe<tf2_msgs::TFMessage>(
      topics::kTfStatic, kResultQueue,
      [this](const tf2_msgs::TFMessageConstPtr& message) { onTf(message, true); });
  tf_moving_ = handle.subscribe<tf2_msgs::TFMessage>(
      topics::kTf, kResultQueue,
      [this](const tf2_msgs::TFMessageConstPtr& message) { onTf(message, false); });
}

void MotionInputs::wantPose(const std_msgs::Header& header) {
  if (!tf_) {
    return;
  }
  try {
    give(tf_->ask(fromRos(header.stamp), header.frame_id));
  } catch (const std::exception& error) {
    callbacks_.unusable(error.what());
  }
  // A tree that lags catches up; one that does not hold the frames never does.
  constexpr std::size_t kManyPending = 30;
  if (tf_->pending() > kManyPending) {
    callbacks_.unusable("tf knows no pose for " + std::to_string(tf_->pending()) +
                        " frames: " + tf_->whyWaiting());
  }
}

void MotionInputs::startPass() {
  if (tf_) {
    tf_->startPass();
  }
}

void MotionInputs::onDepth(const sensor_msgs::ImageConstPtr& message) {
  try {
    callbacks_.depth(message->header, toDepthMap(message, depth_factor_));
  } catch (const std::exception& error) {
    callbacks_.unusable(error.what());
  }
}

void MotionInputs::onPose(const topic_tools::ShapeShifter::ConstPtr& message) {
  try {
    callbacks_.pose(poseFromAny(*message));
  } catch (const std::exception& error) {
    callbacks_.unusable(error.what());
  }
}

void MotionInputs::onTf(const tf2_msgs::TFMessageConstPtr& message, bool is_static) {
  try {
    give(tf_->add(*message, is_static));
  } catch (const std::exception& error) {
    callbacks_.unusable(error.what());
  }
}

void MotionInputs::give(const std::vector<StampedPose>& poses) {
  for (const StampedPose& pose : poses) {
    callbacks_.pose(pose);
  }
}

}  // namespace evolin::ros_shell
