// Local maxima, the best k, bilinear samples.
#include "evolin_ros/inference/feature_map.h"

#include <algorithm>
#include <cmath>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

bool isGreatest(const cv::Mat& map, int x, int y, int reach) {
  const float value = map.ptr<float>(y)[x];
  const int left = std::max(0, x - reach);
  const int right = std::min(map.cols - 1, x + reach);
  const int bottom = std::min(map.rows - 1, y + reach);
  for (int j = std::max(0, y - reach); j <= bottom; ++j) {
    const float* row = map.ptr<float>(j);
    for (int i = left; i <= right; ++i) {
      if (row[i] > value) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

std::vector<Peak> localMaxima(const cv::Mat& map, int window, float threshold) {
  if (window < 1 || window % 2 == 0) {
    throw Error("local maxima need an odd window, got " + std::to_string(window));
  }
  std::vector<Peak> peaks;
  if (map.empty()) {
    return peaks;
  }
  if (map.dims != 2 || map.type() != CV_32FC1) {
    throw Error("local maxima are of a map of floats, got OpenCV's type " +
                std::to_string(map.type()));
  }
  for (int y = 0; y < map.rows; ++y) {
    const float* row = map.ptr<float>(y);
    for (int x = 0; x < map.cols; ++x) {
      if (row[x] > threshold && isGreatest(map, x, y, window / 2)) {
        peaks.push_back({x, y, row[x]});
      }
    }
  }
  return peaks;
}

void keepBest(std::size_t count, std::vector<Peak>* peaks) {
  std::stable_sort(peaks->begin(), peaks->end(),
                   [](const Peak& a, const Peak& b) { return a.value > b.value; });
  if (peaks->size() > count) {
    peaks->resize(count);
  }
}

double mapCoordinate(double value, int from, int to, Alignment alignment) {
  if (alignment == Alignment::kHalfPixel) {
    return (value + 0.5) * to / from - 0.5;
  }
  return from > 1 ? value * (to - 1) / (from - 1) : 0.0;
}

void sampleBilinear(const cv::Mat& maps, double x, double y, Beyond beyond,
                    std::vector<float>* samples) {
  if (maps.dims != 3 || maps.type() != CV_32F || maps.total() == 0 || !maps.isContinuous()) {
    throw Error("samples are of a tensor [channels, height, width] of floats");
  }
  const int height = maps.size[1];
  const int width = maps.size[2];
  samples->assign(static_cast<std::size_t>(maps.size[0]), 0.0F);
  if (!std::isfinite(x) || !std::isfinite(y)) {
    return;
  }
  if (beyond == Beyond::kNearest) {
    x = std::clamp(x, 0.0, width - 1.0);
    y = std::clamp(y, 0.0, height - 1.0);
  } else if (x <= -1 || y <= -1 || x >= width || y >= height) {
    return;
  }
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const double right = x - x0;
  const double lower = y - y0;
  for (std::size_t c = 0; c < samples->size(); ++c) {
    const float* map = maps.ptr<float>(static_cast<int>(c));
    const auto at = [&](int column, int row, double weight) {
      const bool inside = column >= 0 && row >= 0 && column < width && row < height;
      return inside && weight > 0 ? weight * map[row * width + column] : 0.0;
    };
    (*samples)[c] = static_cast<float>(
        at(x0, y0, (1 - right) * (1 - lower)) + at(x0 + 1, y0, right * (1 - lower)) +
        at(x0, y0 + 1, (1 - right) * lower) + at(x0 + 1, y0 + 1, right * lower));
  }
}

}  // namespace evolin
