// From the maps of LSDNet to segments.
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/geometry/line_segment.h"
#include "lsdnet_regions.h"
#include "lsdnet_segments.h"

namespace evolin::lsdnet {

struct DecodingOptions {
  bool compatible = false;   ///< keeps the authors' segments of no length: see Splitter
  bool single_pass = false;  ///< grows regions in the whole image, without quarters
};

/// Decodes one image's maps. Keeps its memory.
class Decoder {
 public:
  explicit Decoder(const DecodingOptions& options);

  /// Segments by falling score (mean probability), ends in whole pixels of an image of `size`.
  /// `maps` is a float tensor [rows, columns, 2] or [1, rows, columns, 2] of at least 4 x 4
  /// pixels: probability, and angle / pi. Throws Error for another shape.
  LineSegments decode(const cv::Mat& maps, cv::Size size);

 private:
  DecodingOptions options_;
  RegionGrowing growing_;
  Splitter splitter_;
  std::vector<MapSegment> segments_;
};

}  // namespace evolin::lsdnet
