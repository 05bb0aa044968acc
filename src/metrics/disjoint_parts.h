// Elements in disjoint parts that grow together (union-find).
#pragma once

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

  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = find(a);
    const std::uint32_t root_b = find(b);
    // The lower number stays: neighbours in a scan then find their root in one step.
    if (root_a < root_b) {
      parents_[root_b] = root_a;
    } else {
      parents_[root_a] = root_b;
    }
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace evolin
