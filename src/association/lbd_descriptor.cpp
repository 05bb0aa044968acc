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

// Sobel's two filters share their sums over a column, and both see the border pixel beyond it. The
// rows do not overlap, which lets the compiler take many pixels at a time.
void sumColumns(const std::uint8_t* __restrict above, const std::uint8_t* __restrict here,
                const std::uint8_t* __restrict below, int width, std::int16_t* __restrict sum,
                std::int16_t* __restrict difference) {
  for (int x = 0; x < width; ++x) {
    sum[x] = static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
    difference[x] = static_cast<std::int16_t>(below[x] - above[x]);
  }
}

// From one pixel left of a row to one right of it: to words of both derivatives.
void combineColumns(const std::int16_t* __restrict sum, const std::int16_t* __restrict difference,
                    int width, std::int32_t* __restrict out) {
  for (int x = 0; x < width; ++x) {
    const int dx = sum[x + 2] - sum[x];
    const int dy = difference[x] + 2 * difference[x + 1] + difference[x + 2];
    out[x] = (dx & 0xFFFF) + dy * 65536;
  }
}

cv::Mat1i computeGradient(const cv::Mat& gray) {
  cv::Mat smooth;
  // OpenCV's filters would see the pixels around a window into a larger image.
  const cv::Mat own = gray.isSubmatrix() ? gray.clone() : gray;
  cv::GaussianBlur(own, smooth, cv::Size(5, 5), 1.0, 1.0, cv::BORDER_REPLICATE);

  cv::Mat1i gradient(gray.size());
  std::vector<std::int16_t> sums(static_cast<std::size_t>(gray.cols) + 2);
  std::vector<std::int16_t> differences(sums.size());
  for (int y = 0; y < gray.rows; ++y) {
    const int above = std::max(y - 1, 0);
    const int below = std::min(y + 1, gray.rows - 1);
    sumColumns(smooth.ptr(above), smooth.ptr(y), smooth.ptr(below), gray.cols, sums.data() + 1,
               differences.data() + 1);
    for (std::vector<std::int16_t>* row : {&sums, &differences}) {
      row->front() = (*row)[1];
      row->back() = (*row)[row->size() - 2];
    }
    combineColumns(sums.data(), differences.data(), gray.cols, gradient[y]);
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

// Means and standard deviations of the weighted rows in each band and its neighbours. Band by band:
// GCC 10 leaves rows out of the sums where a row is spread over its bands instead.
void bandStatistics(const LbdRowSums& sums, const Weights& weights, float* descriptor) {
  std::array<std::array<float, kSums>, kRows> values;
  for (int h = 0; h < kRows; ++h) {
    for (int s = 0; s < kSums; ++s) {
      values[h][s] = weights.global[h] * sums.values[s][h];
    }
  }
  for (int b = 0; b < kBands; ++b) {
    const int first = (b - 1) * kBandRows;
    // A band beyond the support does not exist.
    const int begin = std::max(first, 0);
    const int end = std::min((b + 2) * kBandRows, kRows);
    std::array<float, kSums> total{};
    std::array<float, kSums> squares{};
    for (int h = begin; h < end; ++h) {
      for (int s = 0; s < kSums; ++s) {
        const float weighted = weights.local[h - first] * values[h][s];
        total[s] += weighted;
        squares[s] += weighted * weighted;
      }
    }
    const float inverse = 1.0F / static_cast<float>(end - begin);
    float* const out = descriptor + b * 2 * kSums;
    for (int s = 0; s < kSums; ++s) {
      const float mean = total[s] * inverse;
      out[s] = mean;
      out[kSums + s] = std::sqrt(std::max(0.0F, squares[s] * inverse - mean * mean));
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
  const cv::Mat1i gradient = computeGradient(gray);
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
    const LbdSupport support = makeSupport(x1, y1, x2, y2);
    if (support.samples == 0) {
      continue;  // the row stays zero
    }
    LbdRowSums sums;
    sumLbdRows({gradient[0], gradient.cols, gradient.rows}, support,
               !isInside(support, gradient.cols, gradient.rows), &sums);
    bandStatistics(sums, weights, descriptor);
    normalize(descriptor);
  }
  return descriptors;
}

}  // namespace evolin
