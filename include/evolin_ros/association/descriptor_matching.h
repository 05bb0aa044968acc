// Matching of descriptors by nearest neighbour.
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Pairs each row of `first` with the row of `second` at the smallest Euclidean distance (the
/// lowest row on ties), sorted by the first index. With `cross_check` a pair stays only when its
/// first row is also the nearest to its second. Rows that hold a value that is not finite never
/// match. Both CV_32F with one descriptor a row; throws Error when types or widths differ. An empty
/// matrix is no descriptors.
LineMatches matchDescriptors(const cv::Mat& first, const cv::Mat& second, bool cross_check);

}  // namespace evolin
