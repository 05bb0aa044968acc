// The lines of LSD in one image: the stages of the method put together.
#pragma once

#include "evolin_ros/geometry/line_segment.h"
#include "lsd_field.h"
#include "lsd_region.h"
#include "lsd_validation.h"

namespace evolin::lsd {

/// Keeps its buffers from image to image.
class LineFinder {
 public:
  LineFinder(const LsdParameters& parameters, const FieldStyle& style)
      : parameters_(parameters), builder_(parameters, style), validation_(parameters.compatible) {}

  /// Lines of `gray` (CV_8UC1) in the order of their seeds, until the next call; scores with the
  /// advanced refinement only.
  const LineSegments& find(const cv::Mat& gray);

 private:
  LsdParameters parameters_;
  FieldBuilder builder_;
  Field field_;
  RegionGrower grower_;
  Validation validation_;
  LineSegments found_;
};

}  // namespace evolin::lsd
