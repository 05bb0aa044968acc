// Pictures of lines and matches for people to look at.
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

struct LineStyle {
  int width = 1;           ///< pixels
  bool endpoints = false;  ///< a dot on each
};

/// A BGR copy of `image` (CV_8UC1 or CV_8UC3) with the lines on it; a line that is not finite is
/// left out.
cv::Mat drawLines(const cv::Mat& image, const LineSegments& lines, const LineStyle& style = {});

/// Both images side by side with the matched lines, each pair in a colour of its own.
cv::Mat drawMatches(const cv::Mat& first_image, const LineSegments& first_lines,
                    const cv::Mat& second_image, const LineSegments& second_lines,
                    const LineMatches& matches);

}  // namespace evolin
