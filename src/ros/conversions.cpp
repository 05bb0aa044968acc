// Field by field; whatever a message cannot hold is an error, never a silent change.
#include "conversions.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

evolin_ros::Line toMessage(const LineSegment& segment) {
  evolin_ros::Line line;
  line.x1 = segment.x1;
  line.y1 = segment.y1;
  line.x2 = segment.x2;
  line.y2 = segment.y2;
  line.score = segment.score;
  line.id = segment.id;
  return line;
}

LineSegment fromMessage(const evolin_ros::Line& line) {
  LineSegment segment;
  segment.x1 = line.x1;
  segment.y1 = line.y1;
  segment.x2 = line.x2;
  segment.y2 = line.y2;
  segment.score = line.score;
  segment.id = line.id;
  return segment;
}

std_msgs::Header makeHeader(Stamp stamp, const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp = toRosTime(stamp);
  header.frame_id = frame_id;
  return header;
}

constexpr char kImageEncodings[] = "mono8, bgr8, rgb8, bgra8 or another 8-bit colour encoding";
constexpr char kDepthEncodings[] = "32FC1 (metres) or 16UC1";

Error unusable(const std::string& kind, const sensor_msgs::Image& image,
               const std::string& expected, const std::string& reason) {
  return Error(kind + " of encoding " + quote(image.encoding) + ", " + std::to_string(image.width) +
               "x" + std::to_string(image.height) + ", step " + std::to_string(image.step) +
               ": expected " + expected + " (" + reason + ")");
}

ros::Duration toDuration(double seconds) {
  try {
    return ros::Duration(seconds);
  } catch (const std::runtime_error&) {
    throw Error("processing time of " + formatDouble(seconds) +
                " s: ROS 1 holds durations of up to 2147483647 s");
  }
}

/// K, width and height of the message are those of the whole, unbinned image; the camera's become
/// those of the images that really come.
void takeCutAndBinning(const sensor_msgs::CameraInfo& message, Camera* camera) {
  const sensor_msgs::RegionOfInterest& cut = message.roi;
  if (cut.width != 0 && cut.height != 0) {
    camera->width = static_cast<int>(cut.width);
    camera->height = static_cast<int>(cut.height);
    camera->cx -= cut.x_offset;
    camera->cy -= cut.y_offset;
  }
  const std::uint32_t across = std::max(message.binning_x, 1U);
  const std::uint32_t down = std::max(message.binning_y, 1U);
  camera->width /= static_cast<int>(across);
  camera->height /= static_cast<int>(down);
  camera->fx /= across;
  camera->cx /= across;
  camera->fy /= down;
  camera->cy /= down;
}

/// CV_16UC1 or CV_32FC1, a copy.
cv::Mat storedDepth(const sensor_msgs::ImageConstPtr& message) {
  namespace encodings = sensor_msgs::image_encodings;
  const bool metres = message->encoding == encodings::TYPE_32FC1;
  if (!metres && message->encoding != encodings::TYPE_16UC1 &&
      message->encoding != encodings::MONO16) {
    throw unusable("depth image", *message, kDepthEncodings, "another encoding");
  }
  cv::Mat stored;
  try {
    stored = cv_bridge::toCvShare(message)->image.clone();
    const int type = metres ? CV_32FC1 : CV_16UC1;
    if (stored.type() != type) {
      // cv_bridge swaps the bytes of big-endian images but returns them as channels of bytes.
      stored = cv::Mat(stored.rows, stored.cols, type, stored.data).clone();
    }
  } catch (const std::exception& error) {
    throw unusable("depth image", *message, kDepthEncodings, error.what());
  }
  if (stored.empty()) {
    throw Error("depth image at " + formatStamp(fromRos(message->header.stamp)) +
                " s has no pixels");
  }
  return stored;
}

}  // namespace

Stamp fromRos(const ros::Time& time) {
  return static_cast<Stamp>(time.sec) * kNanosecondsPerSecond + time.nsec;
}

ros::Time toRosTime(Stamp stamp) {
  const Stamp seconds = stamp / kNanosecondsPerSecond;
  if (stamp < 0 || seconds > std::numeric_limits<std::uint32_t>::max()) {
    throw Error("stamp " + formatStamp(stamp) +
                " s: ROS 1 holds stamps from 0 to 4294967295.999999999 s");
  }
  return ros::Time(static_cast<std::uint32_t>(seconds),
                   static_cast<std::uint32_t>(stamp % kNanosecondsPerSecond));
}

std_msgs::ColorRGBA toMessage(const Colour& colour) {
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(colour.red) / 255.0F;
  message.g = static_cast<float>(colour.green) / 255.0F;
  message.b = static_cast<float>(colour.blue) / 255.0F;
  message.a = 1;
  return message;
}

std::string withoutLeadingSlash(const std::string& frame_id) {
  return frame_id.empty() || frame_id.front() != '/' ? frame_id : frame_id.substr(1);
}

LineSet fromMessage(const evolin_ros::LineArray& message) {
  LineSet set;
  set.stamp = fromRos(message.header.stamp);
  set.frame_id = withoutLeadingSlash(message.header.frame_id);
  set.source = message.source;
  set.width = static_cast<int>(message.width);
  set.height = static_cast<int>(message.height);
  set.scored = message.has_scores;
  set.processing_time = message.processing_time.toSec();
  set.lines.reserve(message.lines.size());
  for (const evolin_ros::Line& line : message.lines) {
    set.lines.push_back(fromMessage(line));
  }
  return set;
}

evolin_ros::LineArray toMessage(const LineSet& set) {
  evolin_ros::LineArray message;
  message.header = makeHeader(set.stamp, set.frame_id);
  message.width = static_cast<std::uint32_t>(set.width);
  message.height = static_cast<std::uint32_t>(set.height);
  message.source = set.source;
  message.has_scores = set.scored;
  message.processing_time = toDuration(set.processing_time);
  message.lines.reserve(set.lines.size());
  for (const LineSegment& segment : set.lines) {
    message.lines.push_back(toMessage(segment));
  }
  return message;
}

MatchSet fromMessage(const evolin_ros::LineMatchArray& message) {
  MatchSet set;
  set.first_stamp = fromRos(message.first_stamp);
  set.stamp = fromRos(message.header.stamp);
  set.frame_id = withoutLeadingSlash(message.header.frame_id);
  set.source = message.source;
  set.lines_source = message.lines_source;
  set.processing_time = message.processing_time.toSec();
  set.matches.reserve(message.matches.size());
  for (const evolin_ros::LineMatch& match : message.matches) {
    set.matches.push_back({match.first, match.second, match.distance});
  }
  return set;
}

evolin_ros::LineMatchArray toMessage(const MatchSet& set) {
  evolin_ros::LineMatchArray message;
  message.header = makeHeader(set.stamp, set.frame_id);
  message.first_stamp = toRosTime(set.first_stamp);
  message.source = set.source;
  message.lines_source = set.lines_source;
  message.processing_time = toDuration(set.processing_time);
  message.matches.reserve(set.matches.size());
  for (const LineMatch& match : set.matches) {
    evolin_ros::LineMatch pair;
    pair.first = match.first;
    pair.second = match.second;
    pair.distance = match.distance;
    message.matches.push_back(pair);
  }
  return message;
}

Camera fromMessage(const sensor_msgs::CameraInfo& message) {
  if (message.K[0] == 0) {
    throw Error("camera_info: K[0] is 0: the camera is uncalibrated");
  }
  Camera camera;
  camera.width = static_cast<int>(message.width);
  camera.height = static_cast<int>(message.height);
  camera.fx = message.K[0];
  camera.fy = message.K[4];
  camera.cx = message.K[2];
  camera.cy = message.K[5];
  takeCutAndBinning(message, &camera);
  if (!message.distortion_model.empty()) {
    camera.distortion_model = message.distortion_model;
  }
  camera.distortion = message.D;
  validateCamera(camera, "camera_info");
  return camera;
}

sensor_msgs::CameraInfo toMessage(const Camera& camera, const std_msgs::Header& header) {
  sensor_msgs::CameraInfo message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(camera.width);
  message.height = static_cast<std::uint32_t>(camera.height);
  message.distortion_model = camera.distortion_model;
  message.D = camera.distortion;
  if (message.D.empty() && camera.distortion_model == sensor_msgs::distortion_models::PLUMB_BOB) {
    message.D.assign(5, 0.0);
  }
  message.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return message;
}

Pose fromMessage(const geometry_msgs::PoseStamped& message) {
  return fromMessage(message.pose, message.header.stamp);
}

Pose fromMessage(const geometry_msgs::Pose& from, const ros::Time& stamp) {
  Pose pose;
  pose.translation = {from.position.x, from.position.y, from.position.z};
  pose.rotation = {from.orientation.w, from.orientation.x, from.orientation.y, from.orientation.z};
  const double norm = pose.rotation.norm();
  if (!(norm > 0) || !std::isfinite(norm)) {
    throw Error("pose at " + formatStamp(fromRos(stamp)) + " s: quaternion of norm " +
                std::to_string(norm) + ", expected 1");
  }
  if (!pose.translation.allFinite()) {
    throw Error("pose at " + formatStamp(fromRos(stamp)) + " s: the position is not finite");
  }
  pose.rotation.normalize();
  return pose;
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.translation.x();
  message.position.y = pose.translation.y();
  message.position.z = pose.translation.z();
  message.orientation.w = pose.rotation.w();
  message.orientation.x = pose.rotation.x();
  message.orientation.y = pose.rotation.y();
  message.orientation.z = pose.rotation.z();
  return message;
}

Frame toFrame(const sensor_msgs::ImageConstPtr& message) {
  namespace encodings = sensor_msgs::image_encodings;
  const bool one_channel =
      message->encoding == encodings::MONO8 || message->encoding == encodings::TYPE_8UC1;
  const std::string wanted = one_channel ? message->encoding : encodings::BGR8;
  Frame frame;
  frame.stamp = fromRos(message->header.stamp);
  frame.name = formatStamp(frame.stamp);
  try {
    const cv_bridge::CvImageConstPtr shared = cv_bridge::toCvShare(message, wanted);
    frame.image = shared->image;
    frame.owner = std::make_shared<cv_bridge::CvImageConstPtr>(shared);
  } catch (const std::exception& error) {  // cv_bridge's, OpenCV's and sensor_msgs' own
    throw unusable("image", *message, kImageEncodings, error.what());
  }
  if (frame.image.empty()) {
    throw Error("image at " + frame.name + " s has no pixels");
  }
  if (frame.image.type() != CV_8UC1 && frame.image.type() != CV_8UC3) {
    throw unusable("image", *message, kImageEncodings, "no 8-bit picture comes of it");
  }
  return frame;
}

DepthMap toDepthMap(const sensor_msgs::ImageConstPtr& message, double depth_factor) {
  return DepthMap(storedDepth(message), depth_factor);
}

}  // namespace evolin::ros_shell
