// From the maps of M-LSD to segments (Gu, Ko, Go, Lee, Lee, Shin: Towards Light-weight and
// Real-time Line Segment Detection, AAAI 2022).
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin::mlsd {

struct DecodingOptions {
  double score_threshold = 0.01;  ///< centres of a higher probability
  double min_grid_length = 2;     ///< longer segments stay, pixels of the maps
  int candidates = 200;           ///< the best centres, before the length is looked at
};

/// Decodes one image's maps. Keeps its memory.
class Decoder {
 public:
  explicit Decoder(const DecodingOptions& options);

  /// Segments by falling probability of their centre, ends in pixels of an image of `size`, not
  /// cut at its border. `maps` is a float tensor [5, rows, columns] or [1, 5, rows, columns]: the
  /// logit of a centre, then its displacements to the ends: dx1, dy1, dx2, dy2. Segments that are
  /// not finite go. Throws Error for another shape.
  LineSegments decode(const cv::Mat& maps, cv::Size size);

 private:
  DecodingOptions options_;
  float least_logit_;  ///< at or below it no probability is above the threshold
  cv::Mat probability_;
};

}  // namespace evolin::mlsd
