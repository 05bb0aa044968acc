// Segments in space as RViz' markers carry them, and back.
#pragma once

#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "evolin_ros/geometry/projection.h"

namespace evolin::ros_shell {

/// The segments of a LINE_LIST in the marker's frame (metres), its pose applied; a pose whose
/// quaternion is all zero counts as none, as in RViz. Throws Error naming another type, an odd
/// number of points or an unusable pose. Points that are not finite stay what they are.
std::vector<Segment3d> segmentsOf(const visualization_msgs::Marker& message);

}  // namespace evolin::ros_shell
