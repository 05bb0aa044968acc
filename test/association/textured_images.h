// Images and lines that tests of descriptors draw themselves.
#pragma once

#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin::test {

inline LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

inline LineSegment reversed(const LineSegment& line) {
  return segment(line.x2, line.y2, line.x1, line.y1);
}

/// Smooth noise; the same for a seed.
inline cv::Mat texture(int rows, int cols, std::uint64_t seed = 7) {
  cv::Mat image(rows, cols, CV_8UC1);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, cv::Size(9, 9), 2.0);
  return image;
}

/// Textured on the left of column `edge`, grey without texture from there on.
inline cv::Mat halfFlat(int rows, int cols, int edge) {
  cv::Mat image = texture(rows, cols);
  image.colRange(edge, cols).setTo(128);
  return image;
}

}  // namespace evolin::test
