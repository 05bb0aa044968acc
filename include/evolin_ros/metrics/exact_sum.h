// A sum of floating-point numbers that does not depend on their order.
#pragma once

#include <cstdint>

namespace evolin {

/// Sums numbers from 0 to far below 2^64 in fixed point with 64 bits behind the point, so that
/// sums spread over threads or machines and put together in any order are the same to the last bit.
class ExactSum {
 public:
  /// `value` is finite and not negative; what it has below 2^-64 is lost.
  void add(double value) {
    const auto whole = static_cast<std::uint64_t>(value);
    const auto fraction =
        static_cast<std::uint64_t>((value - static_cast<double>(whole)) * kFractionUnits);
    *this += ExactSum(whole, fraction);
  }

  /// By value, so that a sum may be added to itself.
  ExactSum& operator+=(ExactSum other) {
    whole_ += other.whole_;
    fraction_ += other.fraction_;
    whole_ += fraction_ < other.fraction_ ? 1 : 0;
    return *this;
  }

  double value() const {
    return static_cast<double>(whole_) + static_cast<double>(fraction_) / kFractionUnits;
  }

  ExactSum() = default;

 private:
  static constexpr double kFractionUnits = 0x1.0p64;  ///< to 1

  ExactSum(std::uint64_t whole, std::uint64_t fraction) : whole_(whole), fraction_(fraction) {}

  std::uint64_t whole_ = 0;
  std::uint64_t fraction_ = 0;  ///< in units of 2^-64
};

}  // namespace evolin
