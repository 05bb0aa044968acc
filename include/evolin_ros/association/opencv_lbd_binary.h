// The binary line band descriptor of OpenCV (module line_descriptor of opencv_contrib), guarded
// against what that implementation does not check itself.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Images wider or higher have no descriptors: OpenCV counts positions in 16 bits, and the support
/// of a line reaches beyond the image.
constexpr int kOpenCvLbdBinaryLargestSide = 32700;

/// "" where this build has OpenCV's BinaryDescriptor, otherwise what is missing.
std::string whyNoOpenCvLbdBinary();

/// As describeLbdBinary, but continuing the image beyond its border by reflection and refusing
/// images of more than kOpenCvLbdBinaryLargestSide pixels a side; throws Error besides where OpenCV
/// fails, UnavailableError where it has no such descriptor. Keeps no state.
BinaryDescriptors describeOpenCvLbdBinary(const cv::Mat& gray, const LineSegments& lines);

}  // namespace evolin
