// The loops of sumLbdRows(), for files that are compiled for different processors. Everything has
// internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include "lbd_rows.h"

namespace evolin {

namespace {

/// What the loops need of a processor, in terms of the compiler's own vectors.
struct FourFloats {
  using Float __attribute__((vector_size(16))) = float;
  using Int __attribute__((vector_size(16))) = std::int32_t;

  static Int gather(const std::int32_t* pixels, const std::uint32_t* places) {
    return Int{pixels[places[0]], pixels[places[1]], pixels[places[2]], pixels[places[3]]};
  }
  static Int lowerHalves(const Int& words) { return (words << 16) >> 16; }
  /// The values above zero and zeros in place of the others.
  static Float positive(const Float& values) { return values > Float{} ? values : Float{}; }
  static Float negative(const Float& values) { return values < Float{} ? values : Float{}; }
};

template <class Vectors>
class LbdLoops {
 public:
  template <bool clamped>
  static void sum(const LbdGradientView& gradient, const LbdSupport& support, LbdRowSums* sums) {
    // The positions grow by repeated addition in single precision, as in the published code:
    // samples that fall between two pixels then go to the same side.
    float x[kLbdLanes];
    float y[kLbdLanes];
    float row_x = support.start_x;
    float row_y = support.start_y;
    for (int lane = 0; lane < kLbdLanes; ++lane) {
      x[lane] = row_x;
      y[lane] = row_y;
      row_x -= support.along_y;
      row_y += support.along_x;
    }
    for (int lane = 0; lane < kLbdLanes; lane += kWidth) {
      sumLanes<clamped>(gradient, support, x + lane, y + lane, lane, sums);
    }
  }

 private:
  using Float = typename Vectors::Float;
  using Int = typename Vectors::Int;

  static constexpr int kWidth = sizeof(Float) / sizeof(float);

  static void store(const Float& values, float* row) {
    __builtin_memcpy(row, &values, sizeof(values));
  }

  /// Samples whose places are found at a time, before any of their pixels is asked for: a
  /// processor then has many of both under way, as no place has to pass from its vector registers
  /// to the others.
  static constexpr int kStretch = 64;

  template <bool clamped>
  static void sumLanes(const LbdGradientView& gradient, const LbdSupport& support,
                       const float* start_x, const float* start_y, int lane, LbdRowSums* sums) {
    const Float none = {};
    const float along_x = support.along_x;
    const float along_y = support.along_y;
    const std::int32_t* const pixels = gradient.pixels;
    Float x;
    Float y;
    __builtin_memcpy(&x, start_x, sizeof(x));
    __builtin_memcpy(&y, start_y, sizeof(y));
    Float along_positive = none;
    Float along_negative = none;
    Float across_positive = none;
    Float across_negative = none;
    for (int left = support.samples; left > 0; left -= kStretch) {
      const int count = left < kStretch ? left : kStretch;
      std::uint32_t places[kStretch * kWidth];
      findPlaces<clamped>(gradient, support, count, &x, &y, places);
      for (int k = 0; k < count; ++k) {
        const Int words = Vectors::gather(pixels, places + k * kWidth);
        const Float dx = __builtin_convertvector(Vectors::lowerHalves(words), Float);
        const Float dy = __builtin_convertvector(words >> 16, Float);
        const Float along = dx * along_x + dy * along_y;
        const Float across = dy * along_x - dx * along_y;
        along_positive += Vectors::positive(along);
        along_negative += Vectors::negative(along);
        across_positive += Vectors::positive(across);
        across_negative += Vectors::negative(across);
      }
    }
    store(along_positive, sums->values[0] + lane);
    store(none - along_negative, sums->values[1] + lane);
    store(across_positive, sums->values[2] + lane);
    store(none - across_negative, sums->values[3] + lane);
  }

  /// Of `count` samples, and moves the position on to the next one. Positions are never below zero
  /// after the clamp, so cutting off the fraction of x + 0.5 rounds halves away from zero.
  template <bool clamped>
  static void findPlaces(const LbdGradientView& gradient, const LbdSupport& support, int count,
                         Float* x_io, Float* y_io, std::uint32_t* places) {
    const Float none = {};
    const Float last_x = none + static_cast<float>(gradient.width - 1);
    const Float last_y = none + static_cast<float>(gradient.height - 1);
    Float x = *x_io;
    Float y = *y_io;
    for (int k = 0; k < count; ++k) {
      Float px = x;
      Float py = y;
      if (clamped) {
        px = px > none ? px : none;
        px = px < last_x ? px : last_x;
        py = py > none ? py : none;
        py = py < last_y ? py : last_y;
      }
      const Int place = __builtin_convertvector(py + 0.5F, Int) * gradient.width +
                        __builtin_convertvector(px + 0.5F, Int);
      __builtin_memcpy(places + k * kWidth, &place, sizeof(place));
      x += support.along_x;
      y += support.along_y;
    }
    *x_io = x;
    *y_io = y;
  }
};

}  // namespace

}  // namespace evolin
