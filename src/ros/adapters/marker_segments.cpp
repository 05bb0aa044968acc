// Points two by two.
#include "marker_segments.h"

#include "conversions.h"
#include "evolin_ros/base/error.h"

namespace evolin::ros_shell {

std::vector<Segment3d> segmentsOf(const visualization_msgs::Marker& message) {
  if (message.type != visualization_msgs::Marker::LINE_LIST) {
    throw Error("a marker of type " + std::to_string(message.type) + ", expected LINE_LIST (" +
                std::to_string(visualization_msgs::Marker::LINE_LIST) + ")");
  }
  if (message.points.size() % 2 != 0) {
    throw Error("a line list of " + std::to_string(message.points.size()) +
                " points, expected an even number");
  }
  const geometry_msgs::Quaternion& turn = message.pose.orientation;
  geometry_msgs::Pose usable = message.pose;
  if (turn.x == 0 && turn.y == 0 && turn.z == 0 && turn.w == 0) {
    usable.orientation.w = 1;
  }
  const Pose pose = fromMessage(usable, message.header.stamp);
  const auto point = [&](const geometry_msgs::Point& from) {
    return Eigen::Vector3d(pose.rotation * Eigen::Vector3d(from.x, from.y, from.z) +
                           pose.translation);
  };
  std::vector<Segment3d> segments;
  for (std::size_t i = 0; i + 1 < message.points.size(); i += 2) {
    segments.push_back({point(message.points[i]), point(message.points[i + 1])});
  }
  return segments;
}

}  // namespace evolin::ros_shell
