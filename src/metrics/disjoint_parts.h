// Elements in disjoint parts that grow together (union-find).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace evolin {

class DisjointParts {
 public:
  /// Elements 0 to count - 1, each a part of its own.
  explicit DisjointParts(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }

  /// The element that stands for the part of `element`.
  std::uint32_t find(std::uint32_t element) {
    while (parents_[element] != element) {
      parents_[element] = parents_[parents_[element]];
      element = parents_[element];
    }
    return element;
  }

  /// Returns the element that stands for both from now on. It is quickest when `a` stands for its
  /// part already.
  std::uint32_t unite(std::uint32_t a, std::uint32_t b) {
    if (parents_[b] == a) {
      return a;
    }
    const std::uint32_t root_a = find(a);
    const std::uint32_t root_b = find(b);
    // The lower number stays: neighbours in a scan then find their root in one step.
    const std::uint32_t low = std::min(root_a, root_b);
    parents_[std::max(root_a, root_b)] = low;
    return low;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace evolin
