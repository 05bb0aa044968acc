// Markers with stable names, so that a new frame's replace the last one's.
#include "spatial_markers.h"

#include "conversions.h"
#include "evolin_ros/drawing/palette.h"

namespace evolin::ros_shell {

namespace {

geometry_msgs::Point toPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point result;
  result.x = point.x();
  result.y = point.y();
  result.z = point.z();
  return result;
}

}  // namespace

std::vector<SegmentGroup> emptyGroups() {
  return {{"true_positive", toMessage(palette::kTruePositive), {}},
          {"false_positive", toMessage(palette::kFalsePositive), {}},
          {"missed", toMessage(palette::kMissed), {}},
          {"lines", toMessage(palette::kPlain), {}}};
}

visualization_msgs::MarkerArray markersOf(const std_msgs::Header& header,
                                          const std::vector<SegmentGroup>& groups, double width) {
  visualization_msgs::MarkerArray array;
  for (const SegmentGroup& group : groups) {
    visualization_msgs::Marker marker;
    marker.header = header;
    marker.ns = group.name;
    marker.type = visualization_msgs::Marker::LINE_LIST;
    marker.pose.orientation.w = 1;
    // RViz complains of a list without points.
    marker.action = group.segments.empty() ? visualization_msgs::Marker::DELETE
                                           : visualization_msgs::Marker::ADD;
    marker.scale.x = width;
    marker.color = group.color;
    for (const Segment3d& segment : group.segments) {
      marker.points.push_back(toPoint(segment.p1));
      marker.points.push_back(toPoint(segment.p2));
    }
    array.markers.push_back(marker);
  }
  return array;
}

}  // namespace evolin::ros_shell
