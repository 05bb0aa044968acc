// Numbered things by whole distances, for searches whose distances never fall (Dial 1969).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evolin {

/// Grows with the distances that occur: searches that stay near touch little memory.
class BucketQueue {
 public:
  void push(std::int32_t distance, std::uint32_t value) {
    const auto bucket = static_cast<std::size_t>(distance);
    if (bucket >= heads_.size()) {
      grow(bucket);
    }
    entries_.push_back({value, heads_[bucket], distance});
    heads_[bucket] = static_cast<std::uint32_t>(entries_.size() - 1);
    occupied_[bucket / kBits] |= std::uint64_t{1} << (bucket % kBits);
  }

  /// Moves `distance` up to the next bucket that holds a value; false when that is not below `end`.
  bool advance(std::int32_t end, std::int32_t* distance) const {
    const auto bucket = static_cast<std::size_t>(*distance);
    const std::size_t words =
        std::min(occupied_.size(), (static_cast<std::size_t>(end) + kBits - 1) / kBits);
    std::size_t word = bucket / kBits;
    if (word >= words) {
      return false;
    }
    std::uint64_t bits = occupied_[word] & (~std::uint64_t{0} << (bucket % kBits));
    while (bits == 0) {
      if (++word == words) {
        return false;
      }
      bits = occupied_[word];
    }
    *distance = static_cast<std::int32_t>(word * kBits) + __builtin_ctzll(bits);
    return *distance < end;
  }

  /// A value of a bucket that holds one.
  std::uint32_t pop(std::int32_t distance) {
    const auto bucket = static_cast<std::size_t>(distance);
    const Entry entry = entries_[heads_[bucket]];
    heads_[bucket] = entry.next;
    if (entry.next == kNone) {
      occupied_[bucket / kBits] &= ~(std::uint64_t{1} << (bucket % kBits));
    }
    return entry.value;
  }

  void clear() {
    for (const Entry& entry : entries_) {
      const auto bucket = static_cast<std::size_t>(entry.distance);
      heads_[bucket] = kNone;
      occupied_[bucket / kBits] = 0;
    }
    entries_.clear();
  }

 private:
  static constexpr std::size_t kBits = 64;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Entry {
    std::uint32_t value;
    std::uint32_t next;
    std::int32_t distance;
  };

  void grow(std::size_t bucket) {
    const std::size_t words = std::max(bucket / kBits + 1, 2 * occupied_.size());
    occupied_.resize(words, 0);
    heads_.resize(words * kBits, kNone);
  }

  std::vector<std::uint32_t> heads_;     ///< by distance: last entry pushed
  std::vector<std::uint64_t> occupied_;  ///< one bit a bucket
  std::vector<Entry> entries_;
};

}  // namespace evolin
