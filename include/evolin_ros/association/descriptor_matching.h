// Matching of descriptors by nearest neighbour.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Pairs each row of `first` with the row of `second` at the smallest Euclidean distance (the
/// lowest row on ties), sorted by the first index. With `cross_check` a pair stays only when its
/// first row is also the nearest to its second. Rows that hold a value that is not finite never
/// match. Both CV_32F with one descriptor a row; throws Error when types or widths differ. An empty
/// matrix is no descriptors.
LineMatches matchDescriptors(const cv::Mat& first, const cv::Mat& second, bool cross_check);

/// Descriptors made of bits: one a row of CV_8U. A row whose `valid` is 0 never matches.
struct BinaryDescriptors {
  cv::Mat bits;
  std::vector<std::uint8_t> valid;
};

/// The same with the number of bits that differ as distance; pairs further apart than
/// `max_distance` bits are dropped. Throws Error when types or widths differ or `valid` is not as
/// long as `bits` has rows.
LineMatches matchBinaryDescriptors(const BinaryDescriptors& first, const BinaryDescriptors& second,
                                   bool cross_check, int max_distance);

}  // namespace evolin
