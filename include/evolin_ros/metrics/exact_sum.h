// A sum of floating-point numbers that does not depend on their order.
#pragma once

#include <cstdint>

namespace evolin {

/// Sums numbers from 0 to far below 2^63 in fixed point with 63 bits behind the point, so that
/// sums spread over threads or machines and put together in any order are the same to the last bit.
class ExactSum {
 public:
  /// `value` is finite and not negative; what it has below 2^-63 is lost.
  void add(double value) {
    ExactSum summand;
    summand.whole_ = static_cast<std::int64_t>(value);
    summand.fraction_ =
        static_cast<std::int64_t>((value - static_cast<double>(summand.whole_)) * kOne);
    *this += summand;
  }

  /// By value, so that a sum may be added to itself.
  ExactSum& operator+=(ExactSum other) {
    const std::uint64_t fraction =
        static_cast<std::uint64_t>(fraction_) + static_cast<std::uint64_t>(other.fraction_);
    whole_ += other.whole_ + static_cast<std::int64_t>(fraction >> kFractionBits);
    fraction_ = static_cast<std::int64_t>(fraction & kFractionMask);
    return *this;
  }

  double value() const {
    return static_cast<double>(whole_) + static_cast<double>(fraction_) / kOne;
  }

 private:
  static constexpr unsigned kFractionBits = 63;
  static constexpr std::uint64_t kFractionMask = (std::uint64_t{1} << kFractionBits) - 1;
  static constexpr double kOne = 0x1.0p63;

  std::int64_t whole_ = 0;
  std::int64_t fraction_ = 0;  ///< in units of 2^-63, below one
};

}  // namespace evolin
