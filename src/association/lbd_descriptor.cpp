// The float line band descriptor on a single scale.
#include "evolin_ros/association/lbd_descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "lbd_gradient.h"
#include "lbd_rows.h"

namespace evolin {
namespace {

constexpr int kBands = 9;
constexpr int kBandRows = 7;
constexpr int kRows = kBands * kBandRows;
constexpr int kHalfRows = (kRows - 1) / 2;
constexpr int kSums = kLbdSums;
constexpr float kClip = 0.4F;
constexpr float kNormGuard = 1e-5F;

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

LbdSupport makeSupport(float x1, float y1, float x2, float y2) {
  LbdSupport support;
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
bool isInside(const LbdSupport& support, int width, int height) {
  const float drift = std::numeric_limits<float>::epsilon() * static_cast<float>(support.samples) *
                      static_cast<float>(std::max(width, height));
  const float margin = 1.0F + drift;
  const float length = static_cast<float>(support.samples);
  const float depth = static_cast<float>(kLbdLanes);
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

// A row's four sums side by side. Spelled out: GCC 10 leaves rows out of sums that it arranges so
// itself.
using Sums __attribute__((vector_size(kSums * sizeof(float)))) = float;

constexpr int kBandsAtOnce = 3;  // whose sums do not wait for each other

// Means and standard deviations of the weighted rows in each band and its neighbours.
void bandStatistics(const LbdRowSums& sums, const Weights& weights, float* descriptor) {
  // A band beyond the support does not exist; rows of zeros leave the sums as they are.
  std::array<Sums, kRows + 2 * kBandRows> rows{};
  for (int h = 0; h < kRows; ++h) {
    rows[kBandRows + h] = weights.global[h] * Sums{sums.values[0][h], sums.values[1][h],
                                                   sums.values[2][h], sums.values[3][h]};
  }
  for (int band = 0; band < kBands; band += kBandsAtOnce) {
    Sums total[kBandsAtOnce] = {};
    Sums squares[kBandsAtOnce] = {};
    for (int i = 0; i < 3 * kBandRows; ++i) {
      for (int b = 0; b < kBandsAtOnce; ++b) {
        const Sums weighted = weights.local[i] * rows[(band + b) * kBandRows + i];
        total[b] += weighted;
        squares[b] += weighted * weighted;
      }
    }
    for (int b = 0; b < kBandsAtOnce; ++b) {
      const bool outermost = band + b == 0 || band + b == kBands - 1;
      const float inverse = 1.0F / static_cast<float>((outermost ? 2 : 3) * kBandRows);
      const Sums mean = total[b] * inverse;
      const Sums variance = squares[b] * inverse - mean * mean;
      float* const out = descriptor + (band + b) * 2 * kSums;
      for (int s = 0; s < kSums; ++s) {
        out[s] = mean[s];
        out[kSums + s] = std::sqrt(std::max(0.0F, variance[s]));
      }
    }
  }
}

// Means and deviations to the same length, and all of them to length 1.
void normalize(float* descriptor) {
  float mean_squares = 0;
  float deviation_squares = 0;
  for (const float* band = descriptor; band < descriptor + kLbdSize; band += 2 * kSums) {
    for (int s = 0; s < kSums; ++s) {
      mean_squares += band[s] * band[s];
      deviation_squares += band[kSums + s] * band[kSums + s];
    }
  }
  const float mean_scale = 1.0F / (kNormGuard + std::sqrt(mean_squares));
  const float deviation_scale = 1.0F / (kNormGuard + std::sqrt(deviation_squares));
  for (float* band = descriptor; band < descriptor + kLbdSize; band += 2 * kSums) {
    for (int s = 0; s < kSums; ++s) {
      band[s] = std::min(band[s] * mean_scale, kClip);
      band[kSums + s] = std::min(band[kSums + s] * deviation_scale, kClip);
    }
  }
  float all_squares = 0;
  for (int i = 0; i < kLbdSize; ++i) {
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

struct LbdDescriber::Memory {
  LbdGradient gradient;
  const Weights weights;
};

LbdDescriber::LbdDescriber() : memory_(std::make_unique<Memory>()) {}

LbdDescriber::~LbdDescriber() = default;

cv::Mat LbdDescriber::describe(const cv::Mat& gray, const LineSegments& lines) {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw Error("LBD: the image is " + std::to_string(gray.cols) + "x" + std::to_string(gray.rows) +
                " of OpenCV type " + std::to_string(gray.type()) +
                ", expected a non-empty 8-bit grey image");
  }
  cv::Mat descriptors = cv::Mat::zeros(static_cast<int>(lines.size()), kLbdSize, CV_32F);
  if (lines.empty()) {
    return descriptors;
  }
  const LbdGradientView gradient = {
      memory_->gradient.compute({gray.data, gray.step, gray.cols, gray.rows}), gray.cols,
      gray.rows};
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
    const LbdSupport support = makeSupport(x1, y1, x2, y2);
    if (support.samples == 0) {
      continue;  // the row stays zero
    }
    LbdRowSums sums;
    sumLbdRows(gradient, support, !isInside(support, gray.cols, gray.rows), &sums);
    bandStatistics(sums, memory_->weights, descriptor);
    normalize(descriptor);
  }
  return descriptors;
}

cv::Mat describeLbd(const cv::Mat& gray, const LineSegments& lines) {
  return LbdDescriber().describe(gray, lines);
}

}  // namespace evolin
