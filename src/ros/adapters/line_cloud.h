// Lines as PL-VIO, PL-VINS and their kin publish them: a PointCloud with ids and end points in its
// channels.
#pragma once

#include <sensor_msgs/PointCloud.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/geometry/image_view.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin::ros_shell {

struct LineCloudFormat {
  int number_of_cameras = 1;
  int camera_index = 0;  ///< whose lines are taken, from 0
};

/// Throws Error unless 0 <= camera_index < number_of_cameras.
void validate(const LineCloudFormat& format);

struct LineCloud {
  struct Line {
    Eigen::Vector2d start;  ///< on the plane z = 1, undistorted
    Eigen::Vector2d end;
    std::int64_t id = kNoId;
  };

  std::vector<Line> lines;        ///< of the chosen camera, in the message's order
  std::size_t other_cameras = 0;  ///< lines left out because they are another's
  std::size_t unusable = 0;       ///< lines left out: not finite, or an id that is none
  std::string first_problem;      ///< of those; "" without any
  bool inexact_ids = false;       ///< some id on the wire is beyond what it can tell apart
};

/// Reads points[i] = (x, y, 1), the start point on the plane z = 1 without distortion; channel 0 =
/// id * number_of_cameras + camera; channels 1 and 2 = x and y of the end point. All are single
/// precision, so that numbers above 2^24 in channel 0 are not exact. The header is not looked at.
/// Throws Error naming what is wrong with another number of channels, a channel of another length
/// or a point whose z is not 1: such a message is none of these.
LineCloud readLineCloud(const sensor_msgs::PointCloud& message, const LineCloudFormat& format);

/// The lines in the view's pixels, uncut; those without an image there count as unusable in
/// `cloud`.
LineSegments toPixels(const ImageView& view, LineCloud* cloud);

}  // namespace evolin::ros_shell
