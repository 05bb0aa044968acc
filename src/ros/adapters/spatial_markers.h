// Segments in space for RViz.
#pragma once

#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "evolin_ros/geometry/projection.h"

namespace evolin::ros_shell {

/// Segments that look alike: one marker.
struct SegmentGroup {
  std::string name;  ///< the marker's namespace; its id is 0
  std_msgs::ColorRGBA color;
  std::vector<Segment3d> segments;  ///< metres, in the header's frame
};

/// The groups of Lines3d, without segments, in the overlay's colours: true_positive (blue),
/// false_positive (orange), missed (white) and lines (grey: not judged).
std::vector<SegmentGroup> emptyGroups();

/// A LINE_LIST for each group, `width` metres wide; a group without segments takes its marker away.
visualization_msgs::MarkerArray markersOf(const std_msgs::Header& header,
                                          const std::vector<SegmentGroup>& groups, double width);

}  // namespace evolin::ros_shell
