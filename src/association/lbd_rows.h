// Gradient sums over the rows of a line's support: the inner loop of LBD.
#pragma once

#include <cstdint>

namespace evolin {

/// The rows of a support, in lanes that are summed side by side; one is unused and makes them even.
constexpr int kLbdLanes = 64;

/// Along the line: positive, negative; across it: positive, negative.
constexpr int kLbdSums = 4;

/// Both derivatives of a pixel in one word: dx in the lower half, dy in the upper.
struct LbdGradientView {
  const std::int32_t* pixels;
  int width;
  int height;
};

struct LbdSupport {
  int samples;  ///< a row
  float start_x, start_y;
  float along_x, along_y;  ///< unit vector
};

struct LbdRowSums {
  float values[kLbdSums][kLbdLanes];
};

/// Sums the gradient's components along and across the line, row by row. `clamped`: samples outside
/// the image take the nearest pixel's value; else there are none. The same to the last bit whatever
/// the processor.
void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums);

namespace generic {
void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums);
}
/// For processors with AVX2 alone, where there are such.
namespace wide {
void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums);
}
/// For those with AVX-512 (F, DQ, BW and VL).
namespace widest {
void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums);
}

}  // namespace evolin
