// The binary line band descriptor: the signs of the differences between the bands of the float one
// (Zhang, Koch: An efficient and robust line segment matching approach based on LBD descriptor and
// pairwise geometric consistency, JVCIR 2013; the pairs of bands are those of OpenCV's
// BinaryDescriptor).
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Bytes of a descriptor. Byte c compares two of the nine bands of the float descriptor: bit k is
/// set where element k of the first band exceeds that of the second. Of the 36 pairs, in
/// lexicographic order, those of bands 0 and 1 with 7 and 8 are left out.
constexpr int kLbdBinaryBytes = 32;

/// The part of a line that binary descriptors see: inside the image, which here reaches one pixel
/// beyond the outer pixels' centres, as annotations may count up to the width and height. None for
/// a line outside or with a coordinate that is not finite.
std::optional<LineSegment> describedPart(const LineSegment& line, const cv::Size& image);

/// One row a line, in the order of `lines`, taken from describedPart(); its endpoints stay in the
/// order given. Not valid are lines without such a part, without length, beyond
/// kLbdLargestCoordinate, and those with no texture around them. `gray` is CV_8UC1; throws Error
/// for another type or an empty image. Keeps no state.
BinaryDescriptors describeLbdBinary(const cv::Mat& gray, const LineSegments& lines);

}  // namespace evolin
