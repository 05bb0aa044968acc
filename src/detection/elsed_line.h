// The line that ELSED fits to the pixels of a segment while it grows.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "pixel_chains.h"

namespace evolin::elsed {

/// Ordinary least squares in the coordinate across the segment, from whole-number sums: adding and
/// removing pixels leaves no rounding behind.
class IncrementalLine {
 public:
  void clear() { *this = IncrementalLine(); }

  /// The direction that decides which coordinate is fitted, and which way the line points. Turns
  /// the sums over when the coordinate changes.
  void pointTo(std::int32_t dx, std::int32_t dy) {
    const bool horizontal = std::abs(dx) >= std::abs(dy);
    if (horizontal != horizontal_) {
      std::swap(su_, sv_);
      std::swap(suu_, svv_);
    }
    horizontal_ = horizontal;
    dx_ = dx;
    dy_ = dy;
  }

  void add(EdgePixel p) { count(p, 1); }
  void remove(EdgePixel p) { count(p, -1); }

  std::int64_t size() const { return n_; }
  bool horizontal() const { return horizontal_; }

  /// Mean squared distance of the pixels from the line, below `limit`?
  bool fitsWithin(double limit) const {
    const auto uu = static_cast<double>(n_ * suu_ - su_ * su_);
    const auto vv = static_cast<double>(n_ * svv_ - sv_ * sv_);
    const auto uv = static_cast<double>(n_ * suv_ - su_ * sv_);
    const auto n = static_cast<double>(n_);
    // The squared residuals along v shrink by uu^2 / (uu^2 + uv^2) when taken across the line.
    return (uu * vv - uv * uv) * uu < limit * n * n * (uu * uu + uv * uv);
  }

  /// Brings the equation up to date with the pixels.
  void update() {
    const auto slope = static_cast<double>(n_ * suv_ - su_ * sv_);
    const auto spread = static_cast<double>(su_ * su_ - n_ * suu_);
    // These products outgrow 64 bits in very large images.
    c_ = static_cast<double>(sv_) * static_cast<double>(suu_) -
         static_cast<double>(su_) * static_cast<double>(suv_);
    a_ = horizontal_ ? slope : spread;
    b_ = horizontal_ ? spread : slope;
    if (-dx_ * b_ + dy_ * a_ < 0) {
      a_ = -a_;
      b_ = -b_;
      c_ = -c_;
    }
    squared_norm_ = a_ * a_ + b_ * b_;
  }

  /// Is the distance of `p` from the line below the root of `squared_limit`?
  bool isNear(EdgePixel p, double squared_limit) const {
    const double residual = a_ * p.x + b_ * p.y + c_;
    return residual * residual < squared_limit * squared_norm_;
  }

  /// a x + b y + c = 0 with a^2 + b^2 = 1; the line points to (-b, a).
  struct Equation {
    double a = 0;
    double b = 0;
    double c = 0;

    /// The point of the line that is nearest to (x, y).
    std::pair<double, double> project(double x, double y) const {
      const double distance = a * x + b * y + c;
      return {x - a * distance, y - b * distance};
    }
  };

  Equation equation() const {
    const double norm = std::sqrt(squared_norm_);
    return {a_ / norm, b_ / norm, c_ / norm};
  }

 private:
  void count(EdgePixel p, std::int64_t sign) {
    const std::int64_t u = horizontal_ ? p.x : p.y;
    const std::int64_t v = horizontal_ ? p.y : p.x;
    n_ += sign;
    su_ += sign * u;
    sv_ += sign * v;
    suu_ += sign * u * u;
    suv_ += sign * u * v;
    svv_ += sign * v * v;
  }

  bool horizontal_ = true;
  double dx_ = 0;
  double dy_ = 0;
  std::int64_t n_ = 0;
  std::int64_t su_ = 0;  // u runs along the segment, v across it
  std::int64_t sv_ = 0;
  std::int64_t suu_ = 0;
  std::int64_t suv_ = 0;
  std::int64_t svv_ = 0;
  double a_ = 0;
  double b_ = 0;
  double c_ = 0;
  double squared_norm_ = 0;
};

}  // namespace evolin::elsed
