// Depth images as the compressedDepth transport publishes them.
#pragma once

#include <sensor_msgs/CompressedImage.h>

#include <string>

#include "evolin_ros/geometry/projection.h"

namespace evolin::ros_shell {

/// Whether an image of this encoding holds depth: 16UC1, mono16 or 32FC1.
bool isDepthEncoding(const std::string& encoding);

/// Whether CompressedImage::format says that depth is inside: the transport's own format, or PNG of
/// an encoding that depth has ("16UC1; png compressed").
bool isCompressedDepth(const std::string& format);

/// 16UC1 is divided by `depth_factor`; 32FC1 comes back out of the quantised inverse depth, metres,
/// NaN where there is none. Without the transport's header (other formats) the PNG itself is 16UC1.
/// Throws Error naming the format and what is wrong with the data: too short a header, no PNG of 16
/// bits (RVL is not read), a quantisation that is not usable.
DepthMap toDepthMap(const sensor_msgs::CompressedImage& message, double depth_factor);

}  // namespace evolin::ros_shell
