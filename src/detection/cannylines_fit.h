// Least squares of CannyLines: a line through pixels, equal or weighted by their gradients.
#pragma once

#include <vector>

#include "cannylines_edges.h"

namespace evolin::cannylines {

/// v = b + k u, where u is x and v is y, or the other way round when `steep`.
struct LineEquation {
  double k = 0;
  double b = 0;
  bool steep = false;

  int u(EdgePixel p) const { return steep ? p.y : p.x; }
  int v(EdgePixel p) const { return steep ? p.x : p.y; }
  double at(double u) const { return b + k * u; }
  double offset(EdgePixel p) const { return v(p) - at(u(p)); }
};

/// Fits v over u; pixels of one u give a line of slope 0 through their mean.
class LineFitter {
 public:
  /// `compatible`: as the authors' program adds up, in single precision and from the image's corner
  /// on; else in double precision from the first pixel on.
  explicit LineFitter(bool compatible) : compatible_(compatible) {}

  /// `pixels` is not empty.
  LineEquation fit(const std::vector<EdgePixel>& pixels, bool steep) const;
  LineEquation fitByStrength(const std::vector<EdgePixel>& pixels, bool steep,
                             const EdgeFinder& edges) const;

 private:
  bool compatible_;
};

}  // namespace evolin::cannylines
