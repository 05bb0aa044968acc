// Line support regions of LSD and the rectangles that approximate them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "lsd_field.h"

namespace evolin::lsd {

/// A region's approximation: its axis from (x1, y1) to (x2, y2) in pixels of the field.
struct Rectangle {
  double x1 = 0;
  double y1 = 0;
  double x2 = 0;
  double y2 = 0;
  double width = 1;  ///< pixels, at least 1
  double angle = 0;  ///< of the axis, radians, pointing as the level lines do
  double dx = 1;     ///< cosine and sine of the angle
  double dy = 0;
  double tolerance = 0;  ///< of a level line's angle, radians
  double chance = 0;     ///< that a random angle is within the tolerance

  double length() const;
};

struct RegionPixel {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// Grows, fits and refines one region after the other. A pixel serves one region only.
class RegionGrower {
 public:
  /// Starts on a new field, which must outlive the calls that follow.
  void start(const Field& field);

  bool isFree(std::int32_t pixel) const { return used_[static_cast<std::size_t>(pixel)] == 0; }

  /// The pixels connected to `seed` whose level lines keep within `tolerance` radians of the
  /// region's, which follows them.
  void grow(std::int32_t seed, double tolerance);

  std::size_t size() const { return region_.size(); }

  /// The rectangle around the last region. `chance` is that of the tolerance.
  Rectangle fit(double tolerance, double chance) const;

  /// Cuts the last region until its pixels fill `density` of its rectangle: first with a tolerance
  /// of its own, then by distance from the seed. False when nothing is left.
  bool refine(double density, Rectangle* rectangle);

 private:
  void release();
  bool shrink(double density, Rectangle* rectangle);
  double principalAngle(double x, double y, double tolerance) const;
  std::size_t at(RegionPixel p) const {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(field_->width) +
           static_cast<std::size_t>(p.x);
  }

  const Field* field_ = nullptr;
  std::vector<std::uint8_t> used_;
  std::vector<RegionPixel> region_;
  double angle_ = 0;  // of the region's level lines
};

/// |a - b| of two directions, radians, 0 to pi.
inline double angleBetween(double a, double b) {
  const double apart = std::abs(a - b);
  return apart > 1.5 * CV_PI ? std::abs(apart - 2 * CV_PI) : apart;
}

}  // namespace evolin::lsd
