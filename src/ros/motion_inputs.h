// The evaluator's inputs for families that need depth and camera poses: subscriptions that turn
// messages into values.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include <functional>
#include <memory>
#include <string>

#include "evaluator_options.h"
#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/geometry/projection.h"
#include "pose_source.h"

namespace evolin::ros_shell {

/// Callbacks run on the queue of the handle's topics.
class MotionInputs {
 public:
  struct Callbacks {
    std::function<void(const std_msgs::Header&, const DepthMap&)> depth;
    std::function<void(const StampedPose&)> pose;
    std::function<void(const std::string&)> unusable;  ///< a message could not be taken, and why
  };

  /// `handle` is only used in the constructor.
  MotionInputs(ros::NodeHandle& handle, const EvaluatorOptions& options, Callbacks callbacks);

  /// Lines or an image of this header were heard of: their pose is wanted.
  void wantPose(const std_msgs::Header& header);

  /// The sequence begins anew.
  void startPass();

 private:
  void onDepth(const sensor_msgs::ImageConstPtr& message);
  void onPose(const topic_tools::ShapeShifter::ConstPtr& message);
  void onTf(const tf2_msgs::TFMessageConstPtr& message, bool is_static);
  void give(const std::vector<StampedPose>& poses);

  double depth_factor_;
  Callbacks callbacks_;
  std::unique_ptr<TfPoses> tf_;  ///< only where poses come from tf
  ros::Subscriber depth_;
  ros::Subscriber pose_;
  ros::Subscriber tf_moving_;
  ros::Subscriber tf_static_;
};

}  // namespace evolin::ros_shell
