// Logarithms of factorials, for chances of binomial tails.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace evolin {

/// A table that grows as far as it is asked.
class LogFactorials {
 public:
  /// ln(n!) of n >= 0.
  double operator()(int n) {
    const auto at = static_cast<std::size_t>(n);
    while (values_.size() <= at) {
      values_.push_back(values_.back() + std::log(static_cast<double>(values_.size())));
    }
    return values_[at];
  }

 private:
  std::vector<double> values_ = {0};
};

}  // namespace evolin
