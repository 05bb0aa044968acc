// Noise by inversion, so that every library and number of threads gives the same.
#include "sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "counter_random.h"

namespace evolin::synthetic {

namespace {

constexpr int kQuantiles = 1 << 16;

/// Quantiles at (i + 0.5) / kQuantiles.
std::vector<float> makeQuantiles() {
  std::vector<float> quantiles(kQuantiles);
  for (int i = 0; i < kQuantiles; ++i) {
    quantiles[static_cast<std::size_t>(i)] =
        static_cast<float>(normalQuantile((i + 0.5) / kQuantiles));
  }
  return quantiles;
}

std::vector<float> gaussianWeights(double sigma) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4 * sigma)));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    sum += std::exp(-0.5 * i * i / (sigma * sigma));
  }
  for (int i = -reach; i <= reach; ++i) {
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)) / sum));
  }
  return weights;
}

/// Along one axis: `step_x`, `step_y` is a neighbour's offset.
cv::Mat convolved(const cv::Mat& image, const std::vector<float>& weights, int step_x, int step_y) {
  const int reach = static_cast<int>(weights.size() / 2);
  cv::Mat result(image.size(), CV_32FC3);
  for (int y = 0; y < image.rows; ++y) {
    auto* out = result.ptr<cv::Vec3f>(y);
    for (int x = 0; x < image.cols; ++x) {
      cv::Vec3f sum(0, 0, 0);
      for (std::size_t tap = 0; tap < weights.size(); ++tap) {
        const int i = static_cast<int>(tap) - reach;
        const int column = std::clamp(x + i * step_x, 0, image.cols - 1);
        const int row = std::clamp(y + i * step_y, 0, image.rows - 1);
        sum += image.ptr<cv::Vec3f>(row)[column] * weights[tap];
      }
      out[x] = sum;
    }
  }
  return result;
}

}  // namespace

double normalQuantile(double probability) {
  // Newton's method on the distribution function; in the tails its steps are short but never
  // overshoot, because the function is concave above and convex below the middle.
  constexpr double kDensityAtZero = 0.3989422804014327;
  double x = 0;
  for (int step = 0; step < 60; ++step) {
    const double error = 0.5 * std::erfc(-x * 0.7071067811865476) - probability;
    const double move = error / (kDensityAtZero * std::exp(-0.5 * x * x));
    x -= move;
    if (std::abs(move) < 1e-10) {
      break;
    }
  }
  return x;
}

void blur(double sigma, cv::Mat* image) {
  if (sigma <= 0) {
    return;
  }
  const std::vector<float> weights = gaussianWeights(sigma);
  *image = convolved(convolved(*image, weights, 1, 0), weights, 0, 1);
}

cv::Mat digitise(const cv::Mat& image, double sigma, std::uint64_t key) {
  static const std::vector<float> kNormal = makeQuantiles();
  constexpr int kPerHash = 4;  // numbers of 16 bits
  cv::Mat result(image.size(), CV_8UC3);
  const auto strength = static_cast<float>(sigma);
  const int bytes_a_row = image.cols * 3;
  const int hashes_a_row = (bytes_a_row + kPerHash - 1) / kPerHash;
  for (int y = 0; y < image.rows; ++y) {
    const auto* in = image.ptr<float>(y);
    auto* out = result.ptr<std::uint8_t>(y);
    std::uint64_t bits = 0;
    for (int i = 0; i < bytes_a_row; ++i) {
      if (i % kPerHash == 0) {
        bits = mixBits(key, static_cast<std::uint64_t>(y) * hashes_a_row + i / kPerHash);
      }
      const float noise = kNormal[static_cast<std::size_t>(bits & (kQuantiles - 1))];
      bits >>= 16U;
      out[i] = static_cast<std::uint8_t>(std::clamp(in[i] + strength * noise + 0.5F, 0.0F, 255.0F));
    }
  }
  return result;
}

}  // namespace evolin::synthetic
