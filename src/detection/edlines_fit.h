// Lines along chains of edge pixels, as EDLines fits and joins them.
#pragma once

#include <cstddef>
#include <vector>

#include "evolin_ros/detection/edlines.h"
#include "evolin_ros/geometry/line_segment.h"
#include "pixel_chains.h"

namespace evolin::edlines {

/// v = a + b u, where u is x and v is y, or the other way round when `steep`.
struct LineEquation {
  double a = 0;
  double b = 0;
  bool steep = false;

  double squaredDistance(double x, double y) const {
    const double residual = steep ? x - a - b * y : y - a - b * x;
    return residual * residual / (1 + b * b);
  }
};

struct FittedLine {
  LineEquation equation;
  LineSegment segment;
  std::size_t first = 0;   ///< of its pixels in the chain
  std::size_t pixels = 0;  ///< number of them
};

/// Fits lines to one chain after the other.
class LineFitter {
 public:
  explicit LineFitter(const EdLinesParameters& parameters) : parameters_(parameters) {}

  /// Appends the lines of the chain `pixels` of `size`; lines begin with `window` pixels (at least
  /// 2).
  void fit(const EdgePixel* pixels, std::size_t size, std::size_t window,
           std::vector<FittedLine>* lines) const;

  /// Joins neighbours among lines[from], ..., which are one chain's, where they lie on one line.
  void join(std::size_t from, std::vector<FittedLine>* lines) const;

 private:
  bool tryToJoin(FittedLine* line, const FittedLine& other) const;

  EdLinesParameters parameters_;
};

}  // namespace evolin::edlines
