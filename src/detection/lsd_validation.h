// The a-contrario validation of LSD's rectangles: how few would be as good in an image of noise.
#pragma once

#include <array>

#include "log_factorials.h"
#include "lsd_region.h"

namespace evolin::lsd {

/// Keeps its table of logarithms of factorials.
class Validation {
 public:
  /// `compatible`: as OpenCV before 4.8, see LsdParameters.
  explicit Validation(bool compatible) : compatible_(compatible) {}

  /// The field must outlive the calls that follow.
  void start(const Field& field);

  /// log10 of the number of rectangles that are tried.
  double logTests() const { return log_tests_; }

  /// -log10 of the expected number of rectangles in noise that have `aligned` of `pixels` aligned
  /// by a chance of `chance` each.
  double logNfa(int pixels, int aligned, double chance);

  /// -log10(NFA) of a rectangle.
  double logNfa(const Rectangle& rectangle);

  /// Tries finer tolerances and narrower rectangles until -log10(NFA) exceeds `log_eps`; returns
  /// the greatest and leaves its rectangle in `rectangle`.
  double improve(double log_eps, Rectangle* rectangle);

 private:
  struct Point {
    double x;
    double y;
  };
  using Corners = std::array<Point, 4>;

  static Corners cornersOf(const Rectangle& r);
  void scan(const Rectangle& r);
  void scanInWholePixels(const Rectangle& r);
  void count(const Rectangle& r, int y, double left, double right);

  bool compatible_;
  int pixels_ = 0;   // of the rectangle that is being scanned
  int aligned_ = 0;  // of those
  const Field* field_ = nullptr;
  double log_tests_ = 0;
  LogFactorials log_factorial_;
};

}  // namespace evolin::lsd
