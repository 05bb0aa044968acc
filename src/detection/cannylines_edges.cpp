// Thresholds, seeds, chains.
#include "cannylines_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "marked_pixels.h"

namespace evolin::cannylines {
namespace {

constexpr int kLeastStrength = 2;                // of a gradient
constexpr double kLeastThreshold = 4.0 / 3;      // of Canny's filter
constexpr double kHighToLow = 15;                // where the gradients say nothing
constexpr std::size_t kStrengths = 8 * 255 + 2;  // 0 and what the Sobel filter may give
constexpr double kHalfTurn = CV_PI;
constexpr int kSectors = 16;
constexpr std::array<EdgePixel, 8> kNeighbours = {
    {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

}  // namespace

void EdgeFinder::find(const cv::Mat& gray) {
  gradient_.compute(gray, kLeastStrength, &maps_);
  const double pixels = static_cast<double>(gray.cols) * gray.rows;
  meaningful_length_ = static_cast<std::size_t>(2 * std::log(pixels) / std::log(8.0) + 0.5);
  chains_.clear();
  unsorted_seeds_.clear();
  seeds_.clear();
  double low = 0;
  double high = 0;
  if (meaningful_length_ == 0 || !chooseThresholds(&low, &high)) {
    return;
  }
  edges_.find(maps_, low, high);
  sortSeeds();
  chain();
}

bool EdgeFinder::chooseThresholds(double* low, double* high) {
  from_.assign(kStrengths, 0);
  for (const std::uint16_t strength : maps_.strength) ++from_[strength >> 1U];
  from_[0] = 0;
  double pairs = 0;
  for (const std::uint32_t count : from_) {
    pairs += static_cast<double>(count) * (static_cast<double>(count) - 1);
  }
  for (std::size_t i = kStrengths - 1; i > 0; --i) from_[i - 1] += from_[i];
  if (!(pairs > 0)) {
    return false;
  }
  log_pairs_ = std::log(pairs);
  const auto strongestAbove = [&](double share) {
    int strength = static_cast<int>(kStrengths) - 1;
    while (strength > 0 && shareFrom(strength) <= share) --strength;
    return strength;
  };
  const auto pixels = static_cast<double>(maps_.strength.size());
  const auto length = static_cast<double>(meaningful_length_);
  *low =
      std::max<double>(strongestAbove(std::exp(-log_pairs_ / std::sqrt(pixels))), kLeastThreshold);
  const int strong = strongestAbove(std::exp(-log_pairs_ / length));
  *high = std::sqrt((strong > 0 ? strong : kHighToLow * *low) * parameters_.meaningful_gradient);
  return true;
}

/// The direction of the edge in sixteenths of a turn. Edges along rows, columns and diagonals lie
/// between two; which they belong to hangs on the last bit, and so the precision is the published
/// one: single for the angle and the sixteenth, double for what comes between.
std::uint8_t EdgeFinder::sector(EdgePixel p) const {
  constexpr auto kSixteenth = static_cast<float>(kHalfTurn / 8);
  const std::int16_t* derivatives = maps_.derivatives.data() + 2 * maps_.at(p.x, p.y);
  const float angle =
      std::atan2(static_cast<float>(derivatives[0]), static_cast<float>(-derivatives[1]));
  const int sector =
      static_cast<int>((static_cast<double>(angle) + kHalfTurn) / static_cast<double>(kSixteenth));
  return static_cast<std::uint8_t>(sector % kSectors);
}

void EdgeFinder::sortSeeds() {
  for (int y = 0; y < maps_.height; ++y) {
    visitMarked(edges_.row(y), 0, maps_.width, 1, [&](int x) {
      unsorted_seeds_.push_back({x, y});
    });
  }
  sectors_.resize(maps_.strength.size());
  slots_.assign(kStrengths + 1, 0);
  const auto slot = [&](EdgePixel p) {
    return kStrengths - 1 - static_cast<std::size_t>(strength(p));
  };
  for (const EdgePixel& p : unsorted_seeds_) {
    sectors_[maps_.at(p.x, p.y)] = sector(p);
    ++slots_[slot(p) + 1];
  }
  for (std::size_t i = 1; i < slots_.size(); ++i) slots_[i] += slots_[i - 1];
  seeds_.resize(unsorted_seeds_.size());
  for (const EdgePixel& p : unsorted_seeds_) seeds_[slots_[slot(p)]++] = p;
}

void EdgeFinder::chain() {
  for (const EdgePixel& seed : seeds_) {
    // Also where another chain has been: short ones are dropped.
    edges_.row(seed.y)[seed.x] = 0;
    chains_.pixels.push_back(seed);
    follow(seed);
    if (chains_.openLength() > 1) {
      std::reverse(chains_.pixels.begin() + static_cast<std::ptrdiff_t>(chains_.openBegin()),
                   chains_.pixels.end());
    }
    follow(seed);
    if (chains_.openLength() >= meaningful_length_) {
      chains_.close();
    } else {
      chains_.dropOpen();
    }
  }
}

/// Appends the edge pixels from `from` on to the open chain, without it.
void EdgeFinder::follow(EdgePixel from) {
  while (true) {
    const int sector = sectors_[maps_.at(from.x, from.y)];
    bool moved = false;
    for (const EdgePixel& step : kNeighbours) {
      const EdgePixel next{from.x + step.x, from.y + step.y};
      std::uint8_t* mark = edges_.row(next.y) + next.x;
      if (*mark == 0) {
        continue;
      }
      const int turn = (sectors_[maps_.at(next.x, next.y)] - sector + kSectors) % kSectors;
      if (turn <= 1 || turn == kSectors - 1) {
        *mark = 0;
        chains_.pixels.push_back(next);
        from = next;
        moved = true;
        break;
      }
    }
    if (!moved) {
      return;
    }
  }
}

}  // namespace evolin::cannylines
