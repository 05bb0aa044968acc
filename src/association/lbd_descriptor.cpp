// The float line band descriptor on a single scale.
#include "evolin_ros/association/lbd_descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr int kBands = 9;
constexpr int kBandRows = 7;
constexpr int kRows = kBands * kBandRows;
constexpr int kHalfRows = (kRows - 1) / 2;
// The rows lie side by side in the vector registers; one unused lane makes the loops even.
constexpr int kLanes = 64;
constexpr int kSums = 4;  // along the line: positive, negative; across it: positive, negative
constexpr float kClip = 0.4F;
constexpr float kNormGuard = 1e-5F;

template <typename T>
using Lanes = std::array<T, kLanes>;

// Both derivatives of a pixel in one 32-bit word: dx in the lower half, dy in the upper.
struct Gradient {
  int width;
  int height;
  std::vector<std::int32_t> pixels;
};

Gradient computeGradient(const cv::Mat& gray) {
  cv::Mat smooth;
  // OpenCV's filters would see the pixels around a window into a larger image.
  const cv::Mat own = gray.isSubmatrix() ? gray.clone() : gray;
  cv::GaussianBlur(own, smooth, cv::Size(5, 5), 1.0, 1.0, cv::BORDER_REPLICATE);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(smooth, dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
  cv::Sobel(smooth, dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);

  Gradient gradient{gray.cols, gray.rows, {}};
  gradient.pixels.resize(static_cast<std::size_t>(gray.cols) * gray.rows);
  std::int32_t* out = gradient.pixels.data();
  for (int y = 0; y < gray.rows; ++y) {
    const short* row_dx = dx.ptr<short>(y);
    const short* row_dy = dy.ptr<short>(y);
    for (int x = 0; x < gray.cols; ++x) {
      *out++ = static_cast<std::int32_t>(row_dx[x] & 0xFFFF) + (row_dy[x] * 65536);
    }
  }
  return gradient;
}

// Weights of the rows over the whole support and over three neighbouring bands.
struct Weights {
  std::array<float, kRows> global;
  std::array<float, 3 * kBandRows> local;

  Weights() {
    for (int h = 0; h < kRows; ++h) {
      const double d = h - kHalfRows;
      global[h] = static_cast<float>(std::exp(-d * d / (2.0 * kHalfRows * kHalfRows)));
    }
    // Centre and sigma as the published code has them, by integer division.
    constexpr int kCentre = (3 * kBandRows - 1) / 2;
    constexpr int kSigma = (2 * kBandRows + 1) / 2;
    for (int i = 0; i < 3 * kBandRows; ++i) {
      const double d = i - kCentre;
      local[i] = static_cast<float>(std::exp(-d * d / (2.0 * kSigma * kSigma)));
    }
  }
};

struct Support {
  int samples;  // a row
  float start_x, start_y;
  float along_x, along_y;
};

// The positions grow by repeated addition in single precision, as in the published code: samples
// that fall between two pixels then go to the same side.
Support makeSupport(float x1, float y1, float x2, float y2) {
  Support support;
  support.samples = static_cast<int>(std::ceil(std::max(std::abs(x2 - x1), std::abs(y2 - y1))));
  const float direction = std::atan2(y2 - y1, x2 - x1);
  support.along_x = std::cos(direction);
  support.along_y = std::sin(direction);
  const int half_samples = (support.samples - 1) / 2;
  const float half_length = static_cast<float>(half_samples);
  const float half_rows = static_cast<float>(kHalfRows);
  const float middle_x = 0.5F * (x1 + x2);
  const float middle_y = 0.5F * (y1 + y2);
  support.start_x = -support.along_x * half_length + support.along_y * half_rows + middle_x;
  support.start_y = -support.along_y * half_length - support.along_x * half_rows + middle_y;
  return support;
}

// True when every sample lies on a pixel, with a margin for what the additions may drift.
bool isInside(const Support& support, int width, int height) {
  const float drift = std::numeric_limits<float>::epsilon() * static_cast<float>(support.samples) *
                      static_cast<float>(std::max(width, height));
  const float margin = 1.0F + drift;
  const float length = static_cast<float>(support.samples);
  const float depth = static_cast<float>(kLanes);
  const float corner_x[] = {0, support.along_x * length};
  const float corner_y[] = {0, support.along_y * length};
  const float side_x[] = {0, -support.along_y * depth};
  const float side_y[] = {0, support.along_x * depth};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const float x = support.start_x + corner_x[i] + side_x[j];
      const float y = support.start_y + corner_y[i] + side_y[j];
      if (x < margin || y < margin || x > static_cast<float>(width - 1) - margin ||
          y > static_cast<float>(height - 1) - margin) {
        return false;
      }
    }
  }
  return true;
}

struct RowSums {
  alignas(64) std::array<Lanes<float>, kSums> values{};
};

// Sums the gradient's components along and across the line, row by row. With `clamped` samples
// outside the image take the nearest pixel's value. Positions are never below zero after the
// clamp, so cutting off the fraction of x + 0.5 rounds halves away from zero.
template <bool clamped>
void sumRows(const Gradient& gradient, const Support& support, RowSums* sums) {
  alignas(64) Lanes<float> x;
  alignas(64) Lanes<float> y;
  alignas(64) Lanes<std::int32_t> at;
  alignas(64) Lanes<std::int32_t> word;
  const float along_x = support.along_x;
  const float along_y = support.along_y;
  float row_x = support.start_x;
  float row_y = support.start_y;
  for (int h = 0; h < kLanes; ++h) {
    x[h] = row_x;
    y[h] = row_y;
    row_x -= along_y;
    row_y += along_x;
  }
  const float last_x = static_cast<float>(gradient.width - 1);
  const float last_y = static_cast<float>(gradient.height - 1);
  const int width = gradient.width;
  const std::int32_t* const pixels = gradient.pixels.data();
  Lanes<float>& along_positive = sums->values[0];
  Lanes<float>& along_negative = sums->values[1];
  Lanes<float>& across_positive = sums->values[2];
  Lanes<float>& across_negative = sums->values[3];

  for (int k = 0; k < support.samples; ++k) {
    for (int h = 0; h < kLanes; ++h) {
      float px = x[h];
      float py = y[h];
      if (clamped) {
        px = std::min(std::max(px, 0.0F), last_x);
        py = std::min(std::max(py, 0.0F), last_y);
      }
      at[h] = static_cast<std::int32_t>(py + 0.5F) * width + static_cast<std::int32_t>(px + 0.5F);
      x[h] += along_x;
      y[h] += along_y;
    }
    for (int h = 0; h < kLanes; ++h) {
      word[h] = pixels[at[h]];
    }
    for (int h = 0; h < kLanes; ++h) {
      const std::int32_t high = word[h] >> 16;
      const std::int32_t low =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(word[h]) << 16) >> 16;
      const float dx = static_cast<float>(low);
      const float dy = static_cast<float>(high);
      const float along = dx * along_x + dy * along_y;
      const float across = dy * along_x - dx * along_y;
      along_positive[h] += std::max(along, 0.0F);
      along_negative[h] += std::max(-along, 0.0F);
      across_positive[h] += std::max(across, 0.0F);
      across_negative[h] += std::max(-across, 0.0F);
    }
  }
}

// Means and standard deviations of the weighted rows in each band and its neighbours.
void bandStatistics(const RowSums& sums, const Weights& weights, float* descriptor) {
  std::array<std::array<float, kSums>, kBands> total{};
  std::array<std::array<float, kSums>, kBands> squares{};
  for (int h = 0; h < kRows; ++h) {
    const int band = h / kBandRows;
    const int row = h % kBandRows;
    for (int s = 0; s < kSums; ++s) {
      const float value = weights.global[h] * sums.values[s][h];
      for (int neighbour = -1; neighbour <= 1; ++neighbour) {
        const int b = band + neighbour;
        if (b < 0 || b >= kBands) {
          continue;  // a band beyond the support does not exist
        }
        const float weighted = weights.local[row + kBandRows * (1 - neighbour)] * value;
        total[b][s] += weighted;
        squares[b][s] += weighted * weighted;
      }
    }
  }
  for (int b = 0; b < kBands; ++b) {
    const int rows = (b == 0 || b == kBands - 1) ? 2 * kBandRows : 3 * kBandRows;
    const float inverse = 1.0F / static_cast<float>(rows);
    float* const out = descriptor + b * 2 * kSums;
    for (int s = 0; s < kSums; ++s) {
      const float mean = total[b][s] * inverse;
      out[s] = mean;
      out[kSums + s] = std::sqrt(std::max(0.0F, squares[b][s] * inverse - mean * mean));
    }
  }
}

void normalize(float* descriptor) {
  float mean_squares = 0;
  float deviation_squares = 0;
  for (int i = 0; i < kLbdSize; ++i) {
    float& squares = i % (2 * kSums) < kSums ? mean_squares : deviation_squares;
    squares += descriptor[i] * descriptor[i];
  }
  const float mean_scale = 1.0F / (kNormGuard + std::sqrt(mean_squares));
  const float deviation_scale = 1.0F / (kNormGuard + std::sqrt(deviation_squares));
  float all_squares = 0;
  for (int i = 0; i < kLbdSize; ++i) {
    const float scale = i % (2 * kSums) < kSums ? mean_scale : deviation_scale;
    descriptor[i] = std::min(descriptor[i] * scale, kClip);
    all_squares += descriptor[i] * descriptor[i];
  }
  const float scale = 1.0F / (kNormGuard + std::sqrt(all_squares));
  for (int i = 0; i < kLbdSize; ++i) {
    descriptor[i] *= scale;
  }
}

// False for NaN too.
bool isDescribable(float coordinate) { return std::abs(coordinate) <= kLbdLargestCoordinate; }

}  // namespace

cv::Mat describeLbd(const cv::Mat& gray, const LineSegments& lines) {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw Error("LBD: the image is " + std::to_string(gray.cols) + "x" + std::to_string(gray.rows) +
                " of OpenCV type " + std::to_string(gray.type()) +
                ", expected a non-empty 8-bit grey image");
  }
  cv::Mat descriptors = cv::Mat::zeros(static_cast<int>(lines.size()), kLbdSize, CV_32F);
  if (lines.empty()) {
    return descriptors;
  }
  const Gradient gradient = computeGradient(gray);
  const Weights weights;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    float* const descriptor = descriptors.ptr<float>(static_cast<int>(i));
    const auto x1 = static_cast<float>(lines[i].x1);
    const auto y1 = static_cast<float>(lines[i].y1);
    const auto x2 = static_cast<float>(lines[i].x2);
    const auto y2 = static_cast<float>(lines[i].y2);
    if (!isDescribable(x1) || !isDescribable(y1) || !isDescribable(x2) || !isDescribable(y2)) {
      std::fill_n(descriptor, kLbdSize, std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    const Support support = makeSupport(x1, y1, x2, y2);
    if (support.samples == 0) {
      continue;  // the row stays zero
    }
    RowSums sums;
    if (isInside(support, gradient.width, gradient.height)) {
      sumRows<false>(gradient, support, &sums);
    } else {
      sumRows<true>(gradient, support, &sums);
    }
    bandStatistics(sums, weights, descriptor);
    normalize(descriptor);
  }
  return descriptors;
}

}  // namespace evolin
