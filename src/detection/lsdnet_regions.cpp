// The mask and the growing of regions. Every intermediate of the authors' arithmetic is a float:
// compile without floating-point contraction.
#include "lsdnet_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace evolin::lsdnet {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kLeastProbability = 0.4F;
constexpr float kProbabilityTolerance = 0.3F;
constexpr std::size_t kLeastPixels = 11;
constexpr int kWindow = 11;    // of the local threshold, pixels
constexpr double kOffset = 2;  // of the local threshold, grey levels

}  // namespace

void RegionGrowing::setMaps(const float* maps, int rows, int columns) {
  maps_ = maps;
  rows_ = rows;
  columns_ = columns;
  makeMask();
  const std::size_t area = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  direction_x_.resize(area);
  direction_y_.resize(area);
  free_.assign(area, 0);
  const std::uint8_t* mask = mask_.ptr<std::uint8_t>();
  for (std::size_t i = 0; i < area; ++i) {
    const float probability = maps[2 * i];
    const float turns = maps[2 * i + 1];
    if (mask[i] == 0 || !(probability > kLeastProbability) || !std::isfinite(probability) ||
        !std::isfinite(turns)) {
      continue;
    }
    const auto angle = static_cast<float>(static_cast<double>(turns) * kPi);
    const float sine = std::sin(angle);
    const float cosine = std::cos(angle);
    direction_x_[i] = cosine * cosine - sine * sine;
    direction_y_[i] = 2 * sine * cosine;
    free_[i] = 1;
  }
}

void RegionGrowing::makeMask() {
  bytes_.create(rows_, columns_, CV_8UC1);
  std::uint8_t* bytes = bytes_.ptr<std::uint8_t>();
  const std::size_t area = bytes_.total();
  for (std::size_t i = 0; i < area; ++i) {
    const float probability = maps_[2 * i];
    const float clipped = probability > 0 ? std::min(probability, 1.0F) : 0.0F;  // NaN: 0
    bytes[i] = static_cast<std::uint8_t>(std::lrint(255 * clipped));
  }
  cv::adaptiveThreshold(bytes_, mask_, 255, cv::ADAPTIVE_THRESH_GAUSSIAN_C, cv::THRESH_BINARY,
                        kWindow, kOffset);
}

Regions RegionGrowing::grow(const cv::Rect& part) {
  seeds_.clear();
  for (int row = part.y; row < part.y + part.height; ++row) {
    for (int column = part.x; column < part.x + part.width; ++column) {
      const int pixel = row * columns_ + column;
      if (free_[static_cast<std::size_t>(pixel)] != 0) {
        seeds_.push_back(pixel);
      }
    }
  }
  // Of equally probable pixels the later one comes first.
  std::sort(seeds_.begin(), seeds_.end(), [this](int a, int b) {
    const float first = probability(a);
    const float second = probability(b);
    return first > second || (first == second && a > b);
  });
  Regions regions;
  Region region;
  for (const int seed : seeds_) {
    if (free_[static_cast<std::size_t>(seed)] == 0) {
      continue;
    }
    growFrom(seed, part, &region);
    // The pixels of what is too small stay used.
    if (region.pixels.size() >= kLeastPixels) {
      regions.push_back(region);
    }
  }
  return regions;
}

void RegionGrowing::growFrom(int seed, const cv::Rect& part, Region* region) {
  struct Step {
    int row;
    int column;
  };
  constexpr std::array<Step, 8> kNeighbours = {
      {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};
  region->pixels.assign(1, seed);
  float mean_x = direction_x_[static_cast<std::size_t>(seed)];
  float mean_y = direction_y_[static_cast<std::size_t>(seed)];
  float length = 1;  // of the sum of the vectors
  float mean_probability = probability(seed);
  free_[static_cast<std::size_t>(seed)] = 0;
  // The list of pixels is the queue.
  for (std::size_t next = 0; next < region->pixels.size(); ++next) {
    const int row = region->pixels[next] / columns_;
    const int column = region->pixels[next] % columns_;
    for (const Step& step : kNeighbours) {
      const int other_row = row + step.row;
      const int other_column = column + step.column;
      if (other_row < part.y || other_row >= part.y + part.height || other_column < part.x ||
          other_column >= part.x + part.width) {
        continue;
      }
      const int pixel = other_row * columns_ + other_column;
      const auto index = static_cast<std::size_t>(pixel);
      if (free_[index] == 0) {
        continue;
      }
      const float x = direction_x_[index];
      const float y = direction_y_[index];
      const float p = probability(pixel);
      const float dx = mean_x - x;
      const float dy = mean_y - y;
      if (!(dx * dx + dy * dy < kDirectionTolerance) ||
          !(std::abs(mean_probability - p) < kProbabilityTolerance)) {
        continue;
      }
      region->pixels.push_back(pixel);
      free_[index] = 0;
      const auto count = static_cast<float>(region->pixels.size());
      const float longer = std::sqrt(1 + length * length + 2 * length * (mean_x * x + mean_y * y));
      mean_x = (mean_x * length + x) / longer;
      mean_y = (mean_y * length + y) / longer;
      length = longer;
      mean_probability = (mean_probability * (count - 1) + p) / count;
    }
  }
  region->mean_x = mean_x;
  region->mean_y = mean_y;
}

}  // namespace evolin::lsdnet
