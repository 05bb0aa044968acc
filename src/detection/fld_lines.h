// Chains of edge pixels, and the straight pieces of them, as the fast line detector finds them.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "canny_edges.h"
#include "evolin_ros/detection/fld.h"
#include "evolin_ros/geometry/line_segment.h"
#include "pixel_chains.h"

namespace evolin::fld {

/// Finds the lines of one image after the other, in buffers that it keeps.
class LineFinder {
 public:
  explicit LineFinder(const FldParameters& parameters)
      : parameters_(parameters), gradient_(1, 1.0) {}

  /// `gray`: CV_8UC1, any size. Endpoints are in the order in which the edge was followed. The
  /// result is valid until the next call.
  const LineSegments& find(const cv::Mat& gray);

 private:
  void findEdges(const cv::Mat& gray);
  void follow(int x, int y);
  void extractLines();
  void keep(LineSegment line);

  FldParameters parameters_;
  cv::Size size_;
  SmoothedGradient gradient_;
  GradientMaps maps_;
  CannyEdges edges_;
  std::vector<EdgePixel> chain_;
  LineSegments lines_;
};

}  // namespace evolin::fld
