// The 128 x 128 frame in which vectorized distances are measured, whatever the image's size.
#pragma once

#include <string>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/spatial_lines.h"

namespace evolin {

constexpr double kScaledSide = 128;

/// Each axis on its own; score and id stay.
LineSegment scaled(const LineSegment& line, ImageSize size);

/// The frame's lines in its image.
LineSegments scaledLines(const SpatialFrame& frame);

/// "x1,y1,x2,y2" for messages.
std::string coordinates(const LineSegment& line);

}  // namespace evolin
