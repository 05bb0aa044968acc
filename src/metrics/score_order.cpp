// Sorting by digits: comparisons of scores in no order are guesses that a processor gets wrong
// every other time.
#include "score_order.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace evolin {

namespace {

constexpr std::size_t kDigits = 8;
constexpr std::size_t kDigitBits = 8;
constexpr std::size_t kDigitValues = std::size_t{1} << kDigitBits;

/// Fewer are sorted sooner than their digits are counted.
constexpr std::size_t kFewestByDigits = 1024;

struct Keyed {
  std::uint64_t key;
  std::uint32_t place;
};

/// Rises as the score falls, and is the same for -0 and 0.
std::uint64_t keyOf(double score) {
  const double value = score + 0.0;
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;
  return (bits & kSign) != 0 ? bits : ~(bits | kSign);
}

std::size_t digitOf(std::uint64_t key, std::size_t digit) {
  return static_cast<std::size_t>(key >> (digit * kDigitBits)) & (kDigitValues - 1);
}

void sortByDigits(std::vector<Keyed>* keyed) {
  std::array<std::array<std::uint32_t, kDigitValues>, kDigits> counts{};
  for (const Keyed& each : *keyed) {
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      ++counts[digit][digitOf(each.key, digit)];
    }
  }
  std::vector<Keyed> sorted(keyed->size());
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (counts[digit][digitOf(keyed->front().key, digit)] == keyed->size()) {
      continue;  // the same in all
    }
    std::array<std::uint32_t, kDigitValues> next{};
    for (std::size_t value = 1; value < kDigitValues; ++value) {
      next[value] = next[value - 1] + counts[digit][value - 1];
    }
    for (const Keyed& each : *keyed) {
      sorted[next[digitOf(each.key, digit)]++] = each;
    }
    keyed->swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> placesByFallingScore(const std::vector<double>& scores) {
  std::vector<Keyed> keyed;
  keyed.reserve(scores.size());
  for (const double score : scores) {
    keyed.push_back({keyOf(score), static_cast<std::uint32_t>(keyed.size())});
  }
  if (keyed.size() < kFewestByDigits) {
    std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
      return a.key != b.key ? a.key < b.key : a.place < b.place;
    });
  } else {
    sortByDigits(&keyed);
  }
  std::vector<std::uint32_t> places;
  places.reserve(keyed.size());
  for (const Keyed& each : keyed) {
    places.push_back(each.place);
  }
  return places;
}

}  // namespace evolin
