// The loops of LbdGradient, for files that are compiled for different processors; see there and in
// lbd_rows_kernel.h. They are plain ones over rows that do not overlap, which lets the compiler
// take many pixels at a time.
#pragma once

#include <cstdint>

#include "lbd_gradient.h"

namespace evolin {

namespace {

using Byte = std::uint8_t;
using Word = std::uint16_t;

constexpr int kReach = 2;  // pixels on either side that the Gaussian sees

/// Rows of the scratch memory, each with room for what lies beyond the border.
struct GradientRows {
  GradientRows(Word* scratch, int width) {
    const int room = width + 2 * kReach;
    Word** const all[] = {&high, &low, &smooth[0], &smooth[1], &smooth[2], &sum, &difference};
    for (int i = 0; i < kCount; ++i) {
      *all[i] = scratch + static_cast<std::size_t>(i) * static_cast<std::size_t>(room);
    }
  }

  static constexpr int kCount = 7;

  Word* high;  // of the sums over columns: the upper bytes
  Word* low;
  Word* smooth[3];
  Word* sum;
  Word* difference;
};

inline int clampRow(int y, int height) { return y < 0 ? 0 : y < height ? y : height - 1; }

/// `row` begins `reach` values before the first pixel.
inline void extend(Word* row, int width, int reach) {
  for (int i = 0; i < reach; ++i) {
    row[i] = row[reach];
    row[reach + width + i] = row[reach + width - 1];
  }
}

/// The Gaussian over five rows, of 16 bits; its bytes apart, so that they can be weighted in 16
/// bits once more.
inline void smoothColumns(const Byte* __restrict a, const Byte* __restrict b,
                          const Byte* __restrict c, const Byte* __restrict d,
                          const Byte* __restrict e, int width, const LbdGaussian& weights,
                          Word* __restrict high, Word* __restrict low) {
  const Word outer = weights.outer;
  const Word inner = weights.inner;
  const Word middle = weights.middle;
  for (int x = 0; x < width; ++x) {
    const Word value =
        static_cast<Word>(outer * (a[x] + e[x]) + inner * (b[x] + d[x]) + middle * c[x]);
    high[x] = value >> 8;
    low[x] = value & 255;
  }
}

inline void smoothRow(const Word* __restrict high, const Word* __restrict low, int width,
                      const LbdGaussian& weights, Word* __restrict smooth) {
  const Word outer = weights.outer;
  const Word inner = weights.inner;
  const Word middle = weights.middle;
  for (int x = 0; x < width; ++x) {
    const Word upper =
        static_cast<Word>(outer * (high[x] + high[x + 4]) + inner * (high[x + 1] + high[x + 3]) +
                          middle * high[x + 2]);
    const Word lower = static_cast<Word>(outer * (low[x] + low[x + 4]) +
                                         inner * (low[x + 1] + low[x + 3]) + middle * low[x + 2]);
    smooth[x] = static_cast<Word>(upper + (lower >> 8) + 128) >> 8;
  }
}

/// Row y of the smoothed image.
inline void smooth(const LbdImageView& image, const LbdGaussian& weights, int y,
                   const GradientRows& rows, Word* smooth) {
  const Byte* source[2 * kReach + 1];
  for (int i = 0; i <= 2 * kReach; ++i) {
    source[i] = image.pixels +
                static_cast<std::size_t>(clampRow(y + i - kReach, image.height)) * image.stride;
  }
  smoothColumns(source[0], source[1], source[2], source[3], source[4], image.width, weights,
                rows.high + kReach, rows.low + kReach);
  extend(rows.high, image.width, kReach);
  extend(rows.low, image.width, kReach);
  smoothRow(rows.high, rows.low, image.width, weights, smooth);
}

/// Sobel's two filters share their sums over a column. Differences and derivatives below zero are
/// kept as words that lie 65536 above them.
inline void sumColumns(const Word* __restrict above, const Word* __restrict here,
                       const Word* __restrict below, int width, Word* __restrict sum,
                       Word* __restrict difference) {
  for (int x = 0; x < width; ++x) {
    sum[x] = static_cast<Word>(above[x] + 2 * here[x] + below[x]);
    difference[x] = static_cast<Word>(below[x] - above[x]);
  }
}

inline void combineColumns(const Word* __restrict sum, const Word* __restrict difference, int width,
                           std::int32_t* __restrict gradient) {
  for (int x = 0; x < width; ++x) {
    const Word dx = static_cast<Word>(sum[x + 2] - sum[x]);
    const Word dy = static_cast<Word>(difference[x] + 2 * difference[x + 1] + difference[x + 2]);
    gradient[x] = static_cast<std::int32_t>(dx | std::uint32_t{dy} << 16);
  }
}

inline void computeGradient(const LbdImageView& image, const LbdGaussian& weights, Word* scratch,
                            std::int32_t* gradient) {
  const GradientRows rows(scratch, image.width);
  for (int y = 0; y < 2; ++y) {
    smooth(image, weights, clampRow(y, image.height), rows, rows.smooth[y]);
  }
  for (int y = 0; y < image.height; ++y) {
    // The row above the first is like it, as the one below the last.
    Word* const above = rows.smooth[(y == 0 ? 0 : y - 1) % 3];
    Word* const here = rows.smooth[y % 3];
    Word* const below = rows.smooth[(y + 1) % 3];
    if (y > 0) {
      smooth(image, weights, clampRow(y + 1, image.height), rows, below);
    }
    sumColumns(above, here, below, image.width, rows.sum + 1, rows.difference + 1);
    extend(rows.sum, image.width, 1);
    extend(rows.difference, image.width, 1);
    combineColumns(rows.sum, rows.difference, image.width,
                   gradient + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width));
  }
}

}  // namespace

}  // namespace evolin
