// Random numbers as a function of a key and a counter: the same for any order of asking.
#pragma once

#include <cstddef>
#include <cstdint>

namespace evolin::synthetic {

/// A bijection that turns near inputs into unrelated outputs (the finaliser of splitmix64).
constexpr std::uint64_t mixBits(std::uint64_t bits) {
  bits += 0x9E3779B97F4A7C15U;
  bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
  return bits ^ (bits >> 31U);
}

constexpr std::uint64_t mixBits(std::uint64_t key, std::uint64_t counter) {
  return mixBits(mixBits(key) ^ counter);
}

/// Uniform in [0, 1).
constexpr double unitInterval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// Draws one after the other under a key.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t key) : key_(key) {}

  std::uint64_t bits() { return mixBits(key_, counter_++); }
  double uniform(double low, double high) { return low + (high - low) * unitInterval(bits()); }

  /// In [0, count).
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(bits() % static_cast<std::uint64_t>(count));
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace evolin::synthetic
