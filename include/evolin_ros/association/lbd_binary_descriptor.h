// The binary line band descriptor of OpenCV (module line_descriptor of opencv_contrib), guarded
// against what that implementation does not check itself.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Bytes of a descriptor. Byte c compares two of the nine bands of the float descriptor: bit k is
/// set where element k of the first band exceeds that of the second.
constexpr int kLbdBinaryBytes = 32;

/// Images wider or higher have no descriptors: OpenCV counts positions in 16 bits, and the support
/// of a line reaches beyond the image.
constexpr int kLbdBinaryLargestSide = 32700;

/// "" where this build has OpenCV's BinaryDescriptor, otherwise what is missing.
std::string whyNoLbdBinary();

/// One row a line, in the order of `lines`, taken from the part of the line inside the image; its
/// endpoints stay in the order given. The image reaches one pixel beyond the outer pixels' centres
/// here, as annotations may count up to the width and height. Not valid are lines outside, without
/// length or with a coordinate that is not finite, and those with no texture around them. `gray` is
/// CV_8UC1; throws Error for another type, an empty or a too large image and where OpenCV fails,
/// UnavailableError where it has no such descriptor. Keeps no state.
BinaryDescriptors describeLbdBinary(const cv::Mat& gray, const LineSegments& lines);

}  // namespace evolin
