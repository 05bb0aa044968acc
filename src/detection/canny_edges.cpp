// Suppression of what is no maximum across its edge, and hysteresis.
#include "canny_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace evolin {
namespace {

constexpr std::uint8_t kWeak = 1;
// The tangent of 22.5 degrees in units of 2^-15, as OpenCV has it.
constexpr int kTangent = 13573;
constexpr int kTangentShift = 15;

constexpr int kAtOnce = 4;  // pixels

/// Have kAtOnce pixels no strength?
bool isFlat(const std::uint16_t* strength) {
  std::uint64_t block = 0;
  std::memcpy(&block, strength, sizeof(block));
  return (block & 0xfffefffefffefffeU) == 0;
}

}  // namespace

void CannyEdges::prepare(int width, int height) {
  width_ = width;
  height_ = height;
  map_.assign(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2), 0);
  weak_.clear();
  strong_.clear();
}

void CannyEdges::find(const GradientMaps& maps, double low, double high) {
  prepare(maps.width, maps.height);
  const int weakest = leastStrength(low, high) - 1;
  const int strongest = static_cast<int>(std::floor(std::min(std::max(low, high), kMostStrength)));
  for (int y = 0; y < maps.height; ++y) {
    suppress(maps, y, weakest, strongest);
  }
  spread();
}

void CannyEdges::suppress(const GradientMaps& maps, int y, int low, int high) {
  const std::size_t first = maps.at(0, y);
  const std::uint16_t* here = maps.strength.data() + first;
  const std::int16_t* derivatives = maps.derivatives.data() + 2 * first;
  std::uint8_t* marks = row(y);
  // Outside the image there is no gradient.
  const auto neighbour = [&](int x, int dx, int dy) {
    return x + dx < 0 || x + dx >= maps.width || y + dy < 0 || y + dy >= maps.height
               ? 0
               : here[x + dx + dy * maps.width] >> 1;
  };
  const auto visit = [&](int x, auto strength_at) {
    const int strength = here[x] >> 1;
    if (strength <= low) {
      return;
    }
    const int dx = derivatives[2 * x];
    const int dy = derivatives[2 * x + 1];
    const int across = std::abs(dx) * kTangent;
    const int along = std::abs(dy) << kTangentShift;
    bool greatest = false;
    if (along < across) {
      greatest = strength > strength_at(x, -1, 0) && strength >= strength_at(x, 1, 0);
    } else if (along > across + (std::abs(dx) << (kTangentShift + 1))) {
      greatest = strength > strength_at(x, 0, -1) && strength >= strength_at(x, 0, 1);
    } else {
      const int side = (dx ^ dy) < 0 ? -1 : 1;
      greatest = strength > strength_at(x, -side, -1) && strength > strength_at(x, side, 1);
    }
    if (!greatest) {
      return;
    }
    if (strength > high) {
      marks[x] = kEdge;
      strong_.push_back(marks + x);
    } else {
      marks[x] = kWeak;
      weak_.push_back(marks + x);
    }
  };
  if (y == 0 || y == maps.height - 1) {
    for (int x = 0; x < maps.width; ++x) visit(x, neighbour);
    return;
  }
  visit(0, neighbour);
  for (int x = 1; x < maps.width - 1; ++x) {
    if (x + kAtOnce < maps.width && isFlat(here + x)) {
      x += kAtOnce - 1;
      continue;
    }
    visit(x, [&](int at, int dx, int dy) { return here[at + dx + dy * maps.width] >> 1; });
  }
  if (maps.width > 1) {
    visit(maps.width - 1, neighbour);
  }
}

void CannyEdges::spread() {
  if (!weak_.empty()) {
    const std::array<std::ptrdiff_t, 8> around = {-stride() - 1, -stride(), -stride() + 1, -1, 1,
                                                  stride() - 1,  stride(),  stride() + 1};
    while (!strong_.empty()) {
      std::uint8_t* mark = strong_.back();
      strong_.pop_back();
      for (const std::ptrdiff_t offset : around) {
        if (mark[offset] == kWeak) {
          mark[offset] = kEdge;
          strong_.push_back(mark + offset);
        }
      }
    }
  }
  for (std::uint8_t* mark : weak_) {
    if (*mark == kWeak) *mark = 0;
  }
}

void CannyEdges::findByOpenCv(const cv::Mat& gray, double low, double high, int aperture) {
  prepare(gray.cols, gray.rows);
  if (gray.cols < 2 || gray.rows < 2) {
    return;
  }
  const cv::Mat* image = &gray;
  if (gray.isSubmatrix()) {
    gray.copyTo(copy_);
    image = &copy_;
  }
  cv::Mat inner(gray.rows, gray.cols, CV_8UC1, row(0), static_cast<std::size_t>(stride()));
  cv::Canny(*image, inner, low, high, aperture);
}

}  // namespace evolin
