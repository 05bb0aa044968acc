// Reading what was written by another's hand: every assumption is checked.
#include "line_cloud.h"

#include <cmath>
#include <optional>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

constexpr std::size_t kChannels = 3;
/// Whole numbers up to here are exact in single precision.
constexpr float kLargestExact = 16777216.0F;

constexpr char kExpected[] =
    "expected start points (x, y, 1) and the 3 channels id * cameras + camera, end x, end y "
    "(PL-VINS' topic 'linefeature')";

void countUnusable(const std::string& problem, LineCloud* cloud) {
  if (cloud->unusable++ == 0) {
    cloud->first_problem = problem;
  }
}

}  // namespace

void validate(const LineCloudFormat& format) {
  if (format.camera_index < 0 || format.camera_index >= format.number_of_cameras) {
    throw Error("camera_index is " + std::to_string(format.camera_index) + ", expected 0 to " +
                std::to_string(format.number_of_cameras - 1) + " (number_of_cameras is " +
                std::to_string(format.number_of_cameras) + ")");
  }
}

LineCloud readLineCloud(const sensor_msgs::PointCloud& message, const LineCloudFormat& format) {
  validate(format);
  if (message.channels.size() != kChannels) {
    throw Error("a cloud of " + std::to_string(message.channels.size()) + " channels; " +
                kExpected);
  }
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const std::size_t values = message.channels[channel].values.size();
    if (values != message.points.size()) {
      throw Error("channel " + std::to_string(channel) + " has " + std::to_string(values) +
                  " values for " + std::to_string(message.points.size()) + " points; " + kExpected);
    }
  }
  LineCloud cloud;
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const geometry_msgs::Point32& start = message.points[i];
    if (std::isfinite(start.z) && start.z != 1) {
      throw Error("point " + std::to_string(i) +
                  " has z = " + formatDouble(static_cast<double>(start.z)) + "; " + kExpected);
    }
    const std::string row = "line " + std::to_string(i);
    const float number = message.channels[0].values[i];
    if (!(number >= 0) || !std::isfinite(number) || std::floor(number) != number ||
        number > 0x1p62F) {
      countUnusable(row + " has the id " + formatDouble(static_cast<double>(number)) +
                        ", expected a whole number from 0",
                    &cloud);
      continue;
    }
    cloud.inexact_ids = cloud.inexact_ids || number > kLargestExact;
    const auto code = static_cast<std::int64_t>(number);
    if (code % format.number_of_cameras != format.camera_index) {
      ++cloud.other_cameras;
      continue;
    }
    LineCloud::Line line;
    line.start = {start.x, start.y};
    line.end = {message.channels[1].values[i], message.channels[2].values[i]};
    line.id = code / format.number_of_cameras;
    if (!line.start.allFinite() || !line.end.allFinite() || !std::isfinite(start.z)) {
      countUnusable(row + " is not finite", &cloud);
      continue;
    }
    cloud.lines.push_back(line);
  }
  return cloud;
}

LineSegments toPixels(const ImageView& view, LineCloud* cloud) {
  LineSegments segments;
  for (const LineCloud::Line& line : cloud->lines) {
    const std::optional<Eigen::Vector2d> start = view.pixelOf(line.start);
    const std::optional<Eigen::Vector2d> end = view.pixelOf(line.end);
    if (!start || !end) {
      countUnusable("the line of id " + std::to_string(line.id) +
                        " has an endpoint beyond the reach of the lens model",
                    cloud);
      continue;
    }
    LineSegment segment;
    segment.x1 = start->x();
    segment.y1 = start->y();
    segment.x2 = end->x();
    segment.y2 = end->y();
    segment.id = line.id;
    segments.push_back(segment);
  }
  return segments;
}

}  // namespace evolin::ros_shell
