// Messages to values of the core and back, as free functions.
#pragma once

#include <evolin_ros/LineArray.h>
#include <evolin_ros/LineMatchArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/ColorRGBA.h>

#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/drawing/palette.h"
#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin::ros_shell {

Stamp fromRos(const ros::Time& time);
/// Throws Error for a stamp before 1970 or after 2106, which ROS 1 cannot hold.
ros::Time toRosTime(Stamp stamp);

/// `header.stamp` and `header.frame_id` become the set's; a leading slash of the frame is taken
/// away. Values are taken as they are, NaN and infinities included.
LineSet fromMessage(const evolin_ros::LineArray& message);
/// As below, throws Error for a stamp or a processing time that ROS 1 cannot hold.
evolin_ros::LineArray toMessage(const LineSet& set);

MatchSet fromMessage(const evolin_ros::LineMatchArray& message);
evolin_ros::LineMatchArray toMessage(const MatchSet& set);

/// Throws Error naming what is wrong for an uncalibrated camera (K[0] == 0) or an unknown
/// distortion model. Binning and region of interest are applied: the camera is that of the images.
Camera fromMessage(const sensor_msgs::CameraInfo& message);
/// P is K without distortion, R the identity; binning and region of interest are those of the whole
/// image.
sensor_msgs::CameraInfo toMessage(const Camera& camera, const std_msgs::Header& header);

/// The quaternion comes out normalised. Throws Error for one without length and for a position that
/// is not finite.
Pose fromMessage(const geometry_msgs::Pose& message, const ros::Time& stamp);
Pose fromMessage(const geometry_msgs::PoseStamped& message);
geometry_msgs::Pose toMessage(const Pose& pose);

/// The image as CV_8UC1 or BGR CV_8UC3. MONO8 and BGR8 share the message's memory, which lives as
/// long as the returned frame; other encodings are converted. Throws Error naming an encoding that
/// cannot be.
Frame toFrame(const sensor_msgs::ImageConstPtr& message);

/// 16UC1, units of a metre / `depth_factor`, or 32FC1, metres, as stored. Throws Error for another
/// encoding or a malformed image.
DepthMap toDepthMap(const sensor_msgs::ImageConstPtr& message, double depth_factor);

/// Opaque.
std_msgs::ColorRGBA toMessage(const Colour& colour);

/// TUM's bags write "/world"; tf2 and everybody else "world".
std::string withoutLeadingSlash(const std::string& frame_id);

}  // namespace evolin::ros_shell
