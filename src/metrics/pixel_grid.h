// Pixels of one image as numbered cells, sets of them as bits, and discs around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/metrics/rasterization.h"

namespace evolin {

/// A pixel's number. Rows are padded by `reach` cells on every side, so that a disc around a pixel
/// never leaves the grid, and to a power of two, whole words of bits.
using Cell = std::uint32_t;

/// The geometry that all sets of one image share.
class PixelGrid {
 public:
  /// A row of the disc: `length` cells from `first` cells after the centre on (wraps for rows
  /// above).
  struct DiscRow {
    Cell first;
    Cell length;
    std::uint32_t dy_squared;
  };
  /// A cell of the disc, relative to its centre (wraps), and its squared distance.
  struct DiscCell {
    Cell offset;
    std::uint32_t squared;
  };

  PixelGrid(ImageSize size, int reach);

  std::size_t cells() const { return cells_; }
  int reach() const { return reach_; }
  Cell cell(const Pixel& pixel) const {
    return (static_cast<Cell>(pixel.y + reach_) << stride_bits_) +
           static_cast<Cell>(pixel.x + reach_);
  }
  std::uint32_t squaredDistance(Cell a, Cell b) const {
    const Cell column = (Cell{1} << stride_bits_) - 1;
    const auto dx = static_cast<std::int32_t>((a & column) - (b & column));
    const auto dy = static_cast<std::int32_t>((a >> stride_bits_) - (b >> stride_bits_));
    return static_cast<std::uint32_t>(dx * dx + dy * dy);
  }
  const std::vector<DiscRow>& discRows() const { return rows_; }
  const std::vector<DiscCell>& nearestFirst() const { return nearest_first_; }

 private:
  int reach_;
  unsigned stride_bits_;
  std::size_t cells_;
  std::vector<DiscRow> rows_;
  std::vector<DiscCell> nearest_first_;
};

/// The number of ones. Without the processor's instruction, which a portable build may not use, the
/// compiler would call a function.
inline std::uint32_t countBits(std::uint64_t word) {
  constexpr std::uint64_t kPairs = 0x5555555555555555;
  constexpr std::uint64_t kFours = 0x3333333333333333;
  constexpr std::uint64_t kBytes = 0x0F0F0F0F0F0F0F0F;
  constexpr std::uint64_t kSum = 0x0101010101010101;
  word -= (word >> 1U) & kPairs;
  word = (word & kFours) + ((word >> 2U) & kFours);
  return static_cast<std::uint32_t>((((word + (word >> 4U)) & kBytes) * kSum) >> 56U);
}

/// A set of cells, one bit each.
class CellSet {
 public:
  explicit CellSet(const PixelGrid& grid) : words_(grid.cells() / kBits + 1) {}

  void insert(Cell cell) { words_[cell / kBits] |= bit(cell); }
  void insertAll(const std::vector<Cell>& cells) {
    for (const Cell cell : cells) {
      insert(cell);
    }
  }
  void erase(Cell cell) { words_[cell / kBits] &= ~bit(cell); }
  bool contains(Cell cell) const { return (words_[cell / kBits] & bit(cell)) != 0; }

  /// Whether any cell within the reach of `centre` is in the set.
  bool anyNear(const PixelGrid& grid, Cell centre) const {
    std::uint64_t found = 0;
    for (const PixelGrid::DiscRow& row : grid.discRows()) {
      for (Cell done = 0; done < row.length; done += kBits) {
        found |= bits(centre + row.first + done, row.length - done);
      }
    }
    return found != 0;
  }

  /// Calls visit(cell, squared distance) for the set's cells within the reach of `centre`; stops
  /// when it returns false. `visit` may erase the cell that it was called with.
  template <typename Visit>
  void forEachNear(const PixelGrid& grid, Cell centre, const Visit& visit) const {
    for (const PixelGrid::DiscRow& row : grid.discRows()) {
      const Cell first = centre + row.first;
      for (Cell done = 0; done < row.length; done += kBits) {
        std::uint64_t found = bits(first + done, row.length - done);
        for (; found != 0; found &= found - 1) {
          const Cell place = done + static_cast<Cell>(__builtin_ctzll(found));
          const std::int32_t dx =
              static_cast<std::int32_t>(place) - static_cast<std::int32_t>(row.length / 2);
          if (!visit(first + place, row.dy_squared + static_cast<std::uint32_t>(dx * dx))) {
            return;
          }
        }
      }
    }
  }

 private:
  static constexpr Cell kBits = 64;

  static std::uint64_t bit(Cell cell) { return std::uint64_t{1} << (cell % kBits); }

  /// Bit i: whether cell begin + i is in the set; of the first `length` cells, at most 64.
  std::uint64_t bits(Cell begin, Cell length) const {
    const Cell word = begin / kBits;
    const Cell shift = begin % kBits;
    // Two shifts, as one by 64 is undefined.
    const std::uint64_t window = (words_[word] >> shift) | (words_[word + 1] << 1U << (63 - shift));
    return length >= kBits ? window : window & ((std::uint64_t{1} << length) - 1);
  }

  friend class IndexedCells;

  std::vector<std::uint64_t> words_;
};

/// A fixed set of cells, numbered from 0 by rows.
class IndexedCells {
 public:
  IndexedCells(const PixelGrid& grid, const Pixels& pixels);
  /// All of several lists together.
  IndexedCells(const PixelGrid& grid, const std::vector<std::vector<Cell>>& lists);

  const CellSet& set() const { return set_; }
  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t size() const { return cells_.size(); }

  /// The number of a cell of the set.
  std::uint32_t index(Cell cell) const {
    const std::uint64_t below = CellSet::bit(cell) - 1;
    const Cell word = cell / CellSet::kBits;
    return ranks_[word] + countBits(set_.words_[word] & below);
  }

 private:
  void number();

  CellSet set_;
  std::vector<Cell> cells_;           ///< by number
  std::vector<std::uint32_t> ranks_;  ///< cells of the set before each word
};

}  // namespace evolin
