// Row-streaming Gaussian and derivative filters written as plain loops that vectorise.
#include "smoothed_gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace evolin {
namespace {

constexpr int kWeightSum = 256;

/// The pixel within [0, size) that stands for `i` when the image is mirrored at its outer pixels.
int mirrored(int i, int size) {
  if (size == 1) {
    return 0;
  }
  while (i < 0 || i >= size) {
    i = i < 0 ? -i : 2 * (size - 1) - i;
  }
  return i;
}

// The window's size is a template argument so that the sums below are unrolled.
template <int kRadius>
void sumAlongRow(const std::uint8_t* padded, const int* weights, int width, std::uint16_t* sums) {
  for (int x = 0; x < width; ++x) {
    auto sum = static_cast<std::uint16_t>(weights[kRadius] * padded[x + kRadius]);
    for (int k = 0; k < kRadius; ++k) {
      const auto weight = static_cast<std::uint16_t>(weights[k]);
      sum =
          static_cast<std::uint16_t>(sum + weight * (padded[x + k] + padded[x + 2 * kRadius - k]));
    }
    sums[x] = sum;
  }
}

template <int kRadius>
void sumAcrossRows(const std::array<const std::uint16_t*, kMaxSmoothingKernel>& rows,
                   const int* weights, int width, std::uint8_t* smoothed) {
  // Sums of the high and of the low bytes fit into 16 bits, which vectorise best.
  const auto low = [&](int k, int x) {
    return static_cast<std::uint16_t>(rows[static_cast<std::size_t>(k)][x] & 255U);
  };
  const auto high = [&](int k, int x) {
    return static_cast<std::uint16_t>(rows[static_cast<std::size_t>(k)][x] >> 8U);
  };
  for (int x = 0; x < width; ++x) {
    auto centre = static_cast<std::uint16_t>(weights[kRadius]);
    auto high_sum = static_cast<std::uint16_t>(centre * high(kRadius, x) + kWeightSum / 2);
    auto low_sum = static_cast<std::uint16_t>(centre * low(kRadius, x));
    for (int k = 0; k < kRadius; ++k) {
      const auto weight = static_cast<std::uint16_t>(weights[k]);
      const int opposite = 2 * kRadius - k;
      high_sum = static_cast<std::uint16_t>(high_sum + weight * (high(k, x) + high(opposite, x)));
      low_sum = static_cast<std::uint16_t>(low_sum + weight * (low(k, x) + low(opposite, x)));
    }
    smoothed[x] =
        static_cast<std::uint8_t>(static_cast<std::uint16_t>(high_sum + (low_sum >> 8)) >> 8);
  }
}

template <typename Call>
void withRadius(int radius, Call call) {
  switch (radius) {
    case 0:
      return call(std::integral_constant<int, 0>());
    case 1:
      return call(std::integral_constant<int, 1>());
    case 2:
      return call(std::integral_constant<int, 2>());
    case 3:
      return call(std::integral_constant<int, 3>());
    case 4:
      return call(std::integral_constant<int, 4>());
    case 5:
      return call(std::integral_constant<int, 5>());
    case 6:
      return call(std::integral_constant<int, 6>());
    default:
      return call(std::integral_constant<int, 7>());
  }
}

}  // namespace

std::vector<int> gaussianWeights(int kernel, double sigma) {
  const int radius = kernel / 2;
  std::vector<double> exact;
  double total = 0;
  for (int i = -radius; i <= 0; ++i) {
    exact.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    total += (i < 0 ? 2 : 1) * exact.back();
  }
  std::vector<int> weights;
  double carried = 0;
  int sum = 0;
  for (int i = 0; i < radius; ++i) {
    const double wanted = exact[static_cast<std::size_t>(i)] / total * kWeightSum + carried;
    weights.push_back(static_cast<int>(std::lround(wanted)));
    carried = wanted - weights.back();
    sum += weights.back();
  }
  weights.push_back(kWeightSum - 2 * sum);
  return weights;
}

SmoothedGradient::SmoothedGradient(int kernel, double sigma, DerivativeFilter filter)
    : weights_(gaussianWeights(kernel, sigma)), filter_(filter) {}

void SmoothedGradient::smoothAlongRow(const std::uint8_t* row, std::uint16_t* smoothed) {
  const int radius = static_cast<int>(weights_.size()) - 1;
  std::copy(row, row + width_, padded_.begin() + radius);
  for (int k = 1; k <= radius; ++k) {
    padded_[static_cast<std::size_t>(radius - k)] = row[mirrored(-k, width_)];
    padded_[static_cast<std::size_t>(radius + width_ - 1 + k)] =
        row[mirrored(width_ - 1 + k, width_)];
  }
  withRadius(radius, [&](auto r) {
    sumAlongRow<decltype(r)::value>(padded_.data(), weights_.data(), width_, smoothed);
  });
}

void SmoothedGradient::smoothAcrossRows(int y, int height, std::uint8_t* smoothed) const {
  const int radius = static_cast<int>(weights_.size()) - 1;
  const int kept = 2 * radius + 1;
  std::array<const std::uint16_t*, kMaxSmoothingKernel> rows{};
  for (int k = 0; k < kept; ++k) {
    const int slot = mirrored(y + k - radius, height) % kept;
    rows[static_cast<std::size_t>(k)] =
        along_rows_.data() + static_cast<std::ptrdiff_t>(slot) * width_;
  }
  withRadius(radius, [&](auto r) {
    sumAcrossRows<decltype(r)::value>(rows, weights_.data(), width_, smoothed);
  });
}

void SmoothedGradient::differentiate(int y, int threshold, GradientMaps* maps) {
  if (filter_ == DerivativeFilter::kSobel) {
    differentiateBy<DerivativeFilter::kSobel>(y, threshold, maps);
  } else {
    differentiateBy<DerivativeFilter::kPrewittStrength>(y, threshold, maps);
  }
}

template <DerivativeFilter kFilter>
void SmoothedGradient::differentiateBy(int y, int threshold, GradientMaps* maps) {
  constexpr bool kSobel = kFilter == DerivativeFilter::kSobel;
  constexpr int kMiddle = kSobel ? 2 : 1;
  const int stride = width_ + 2;
  const auto row = [&](int r) {
    return smoothed_.data() +
           static_cast<std::ptrdiff_t>(std::clamp(r, 0, maps->height - 1) % 3) * stride;
  };
  const std::uint8_t* above = row(y - 1);
  const std::uint8_t* here = row(y);
  const std::uint8_t* below = row(y + 1);
  std::int16_t* sum = column_sum_.data();
  std::int16_t* slope = column_slope_.data();
  for (int x = 0; x < stride; ++x) {
    sum[x] = static_cast<std::int16_t>(above[x] + kMiddle * here[x] + below[x]);
    slope[x] = static_cast<std::int16_t>(below[x] - above[x]);
  }
  [[maybe_unused]] std::int16_t* derivatives =
      kSobel ? maps->derivatives.data() + 2 * maps->at(0, y) : nullptr;
  std::uint16_t* strength = maps->strength.data() + maps->at(0, y);
  for (int x = 0; x < width_; ++x) {
    const auto dx = static_cast<std::int16_t>(sum[x + 2] - sum[x]);
    const auto dy = static_cast<std::int16_t>(slope[x] + kMiddle * slope[x + 1] + slope[x + 2]);
    if constexpr (kSobel) {
      derivatives[2 * x] = dx;
      derivatives[2 * x + 1] = dy;
    }
    const auto along = static_cast<std::int16_t>(std::abs(dx));
    const auto across = static_cast<std::int16_t>(std::abs(dy));
    const auto both = static_cast<std::int16_t>(along + across);
    const auto kept = static_cast<std::int16_t>(both >= threshold ? both : std::int16_t{0});
    strength[x] = static_cast<std::uint16_t>(2 * kept + (along >= across ? 1 : 0));
  }
}

void SmoothedGradient::compute(const cv::Mat& gray, int threshold, GradientMaps* maps) {
  width_ = gray.cols;
  const int height = gray.rows;
  const int radius = static_cast<int>(weights_.size()) - 1;
  const int kept = 2 * radius + 1;
  const int stride = width_ + 2;
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height);
  maps->width = width_;
  maps->height = height;
  maps->derivatives.resize(filter_ == DerivativeFilter::kSobel ? 2 * pixels : 0);
  maps->strength.resize(pixels);
  padded_.resize(static_cast<std::size_t>(width_ + 2 * radius));
  along_rows_.resize(static_cast<std::size_t>(kept) * static_cast<std::size_t>(width_));
  smoothed_.resize(3 * static_cast<std::size_t>(stride));
  column_sum_.resize(static_cast<std::size_t>(stride));
  column_slope_.resize(static_cast<std::size_t>(stride));

  // Row y is smoothed when the rows that its window covers are; the derivatives follow a row later.
  int read = 0;
  for (int y = 0; y < height; ++y) {
    for (; read < std::min(height, y + radius + 1); ++read) {
      smoothAlongRow(gray.ptr<std::uint8_t>(read),
                     along_rows_.data() + static_cast<std::ptrdiff_t>(read % kept) * width_);
    }
    std::uint8_t* row = smoothed_.data() + static_cast<std::ptrdiff_t>(y % 3) * stride;
    smoothAcrossRows(y, height, row + 1);
    row[0] = row[1];
    row[stride - 1] = row[stride - 2];
    if (y > 0) {
      differentiate(y - 1, threshold, maps);
    }
  }
  differentiate(height - 1, threshold, maps);
}

}  // namespace evolin
