// The loops of sumLbdRows(), for files that are compiled for different processors. Everything has
// internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include "lbd_rows.h"

namespace evolin {

namespace {

struct FourFloats {
  using Float __attribute__((vector_size(16))) = float;
  using Int __attribute__((vector_size(16))) = std::int32_t;
};
struct EightFloats {
  using Float __attribute__((vector_size(32))) = float;
  using Int __attribute__((vector_size(32))) = std::int32_t;
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

  /// Positions are never below zero after the clamp, so cutting off the fraction of x + 0.5 rounds
  /// halves away from zero.
  template <bool clamped>
  static void sumLanes(const LbdGradientView& gradient, const LbdSupport& support,
                       const float* start_x, const float* start_y, int lane, LbdRowSums* sums) {
    const Float none = {};
    const Float last_x = none + static_cast<float>(gradient.width - 1);
    const Float last_y = none + static_cast<float>(gradient.height - 1);
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
    for (int k = 0; k < support.samples; ++k) {
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
      Int word;
      for (int i = 0; i < kWidth; ++i) {
        word[i] = pixels[place[i]];
      }
      const Float dx = __builtin_convertvector((word << 16) >> 16, Float);
      const Float dy = __builtin_convertvector(word >> 16, Float);
      const Float along = dx * along_x + dy * along_y;
      const Float across = dy * along_x - dx * along_y;
      const Float forward = along > none ? along : none;
      const Float upward = across > none ? across : none;
      along_positive += forward;
      along_negative += forward - along;  // exact: one of the two is zero, or both are equal
      across_positive += upward;
      across_negative += upward - across;
      x += along_x;
      y += along_y;
    }
    store(along_positive, sums->values[0] + lane);
    store(along_negative, sums->values[1] + lane);
    store(across_positive, sums->values[2] + lane);
    store(across_negative, sums->values[3] + lane);
  }
};

}  // namespace

}  // namespace evolin
