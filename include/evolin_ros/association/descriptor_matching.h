// Matching of descriptors by nearest neighbour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Which pairs stay; the defaults keep every nearest neighbour that is one both ways.
struct MatchingRules {
  bool cross_check = true;  ///< keep a pair only if each row is the other's nearest
  double max_distance = std::numeric_limits<double>::infinity();  ///< inclusive
  /// Keep a pair only if it is nearer than this share of the distance from its first row to the
  /// second nearest row, and with cross_check from its second row to its own second nearest one
  /// (Lowe 2004); 1: no such test.
  double max_ratio = 1;
  /// Pairs of rows of the first and of the second that come into question; none: all do. What does
  /// not is no one's nearest or second nearest.
  std::function<bool(std::size_t, std::size_t)> may_match;
};

/// Pairs each row of `first` with the row of `second` at the smallest Euclidean distance (the
/// lowest row on ties), sorted by the first index, and keeps what `rules` keep. Rows that hold a
/// value that is not finite never match. Both CV_32F with one descriptor a row; throws Error when
/// types or widths differ. An empty matrix is no descriptors.
LineMatches matchDescriptors(const cv::Mat& first, const cv::Mat& second,
                             const MatchingRules& rules);

/// Descriptors made of bits: one a row of CV_8U. A row whose `valid` is 0 never matches.
struct BinaryDescriptors {
  cv::Mat bits;
  std::vector<std::uint8_t> valid;
};

/// The same with the number of bits that differ as distance. Throws Error when types or widths
/// differ or `valid` is not as long as `bits` has rows.
LineMatches matchBinaryDescriptors(const BinaryDescriptors& first, const BinaryDescriptors& second,
                                   const MatchingRules& rules);

}  // namespace evolin
