// Pixels of one image as numbered cells, sets of them as bits, and discs around them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/metrics/rasterization.h"

namespace evolin {

/// A pixel's number. The image lies in columns of 64 pixels, one word of bits a row, so that the
/// rows of a disc follow each other in memory and its pixels have numbers close together. There is
/// a margin of the reach on every side: a disc never leaves the grid.
using Cell = std::uint32_t;

/// The geometry that all sets of one image share.
class PixelGrid {
 public:
  static constexpr Cell kBits = 64;  ///< of a word

  /// A cell of the disc, relative to its centre.
  struct Offset {
    std::int32_t dx;
    std::int32_t dy;
  };

  PixelGrid(ImageSize size, int reach);

  std::size_t words() const { return words_; }
  int reach() const { return reach_; }
  Cell cell(const Pixel& pixel) const {
    return cellAt(static_cast<Cell>(pixel.x + reach_), static_cast<Cell>(pixel.y + reach_));
  }
  /// `offset` is one of the disc.
  Cell moved(Cell cell, Offset offset) const {
    return cellAt(x(cell) + static_cast<Cell>(offset.dx), y(cell) + static_cast<Cell>(offset.dy));
  }
  std::uint32_t squaredDistance(Cell a, Cell b) const {
    const auto dx = static_cast<std::int32_t>(x(a) - x(b));
    const auto dy = static_cast<std::int32_t>(y(a) - y(b));
    return static_cast<std::uint32_t>(dx * dx + dy * dy);
  }
  /// The whole disc, nearest cells first.
  const std::vector<Offset>& nearestFirst() const { return nearest_first_; }

 private:
  friend class CellSet;
  friend class IndexedCells;

  // With the margin; a column has 1 << column_bits_ words.
  Cell cellAt(Cell x, Cell y) const {
    return ((((x / kBits) << column_bits_) + y) * kBits) + x % kBits;
  }
  Cell x(Cell cell) const { return (cell / kBits >> column_bits_) * kBits + cell % kBits; }
  Cell y(Cell cell) const { return cell / kBits & ((Cell{1} << column_bits_) - 1); }

  /// Of the square around a disc.
  Cell corner(Cell centre) const {
    return cellAt(x(centre) - static_cast<Cell>(reach_), y(centre) - static_cast<Cell>(reach_));
  }

  int reach_;
  Cell side_;  ///< of the square around a disc
  unsigned column_bits_ = 0;
  std::size_t words_ = 0;
  /// Bits of the disc in a square around it, column by column of 64 from the left, each from its
  /// upper row down.
  std::vector<std::uint64_t> masks_;
  std::vector<std::uint32_t> squared_;  ///< distance from the centre of each bit of masks_
  std::vector<Offset> nearest_first_;
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
  explicit CellSet(const PixelGrid& grid) : words_(grid.words()) {}

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
    const Cell side = grid.side_;
    const std::uint64_t* mask = grid.masks_.data();
    Cell begin = grid.corner(centre);
    const Cell shift = begin % kBits;
    std::uint64_t found = 0;
    for (Cell column = 0; column < side; column += kBits) {
      const std::uint64_t* const left = words_.data() + begin / kBits;
      const std::uint64_t* const right = left + (std::size_t{1} << grid.column_bits_);
      for (Cell row = 0; row < side; ++row) {
        found |= window(left[row], right[row], shift) & mask[row];
      }
      mask += side;
      begin += kBits << grid.column_bits_;
    }
    return found != 0;
  }

  /// Calls visit(cell, squared distance) for the set's cells within the reach of `centre`; stops
  /// when it returns false. `visit` may erase the cell that it was called with.
  template <typename Visit>
  void forEachNear(const PixelGrid& grid, Cell centre, const Visit& visit) const {
    forEachRowNear(grid, centre, [&](const Row& row) {
      for (std::uint64_t bits = row.bits; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<Cell>(__builtin_ctzll(bits));
        const Cell place = row.shift + bit;  // from the left word's first cell on
        const Cell cell =
            row.word * kBits + ((place / kBits * kBits) << grid.column_bits_) + place % kBits;
        if (!visit(cell, row.squared[bit])) {
          return false;
        }
      }
      return true;
    });
  }

 private:
  static constexpr Cell kBits = PixelGrid::kBits;
  static constexpr Cell kRows = 32;  ///< of a disc, looked at together

  /// What a set holds of a disc in one row and one column of the grid or two.
  struct Row {
    std::uint64_t bits;            ///< not 0
    Cell word;                     ///< in which the first bit is
    Cell shift;                    ///< of the first bit in it
    const std::uint32_t* squared;  ///< distance of each bit from the centre
  };

  static std::uint64_t bit(Cell cell) { return std::uint64_t{1} << (cell % kBits); }

  /// 64 bits from bit `shift` of `left` on; `right` follows. Two shifts, as one by 64 is undefined.
  static std::uint64_t window(std::uint64_t left, std::uint64_t right, Cell shift) {
    return (left >> shift) | (right << 1U << (63 - shift));
  }

  /// Calls visit(row) for the rows of the disc around `centre` in which the set has cells; stops
  /// when it returns false.
  template <typename Visit>
  void forEachRowNear(const PixelGrid& grid, Cell centre, const Visit& visit) const {
    const Cell side = grid.side_;
    const std::uint64_t* mask = grid.masks_.data();
    const std::uint32_t* squared = grid.squared_.data();
    Cell begin = grid.corner(centre);
    const Cell shift = begin % kBits;
    std::array<std::uint64_t, kRows> found;
    for (Cell column = 0; column < side; column += kBits) {
      const std::uint64_t* const left = words_.data() + begin / kBits;
      for (Cell first = 0; first < side; first += kRows) {
        const Cell rows = std::min(side - first, kRows);
        const std::uint64_t* const right = left + (std::size_t{1} << grid.column_bits_);
        // Loops of vectors apart from what cannot be one. Most discs end in the word they begin in.
        if (shift + side <= kBits) {
          for (Cell row = 0; row < rows; ++row) {
            found[row] = (left[first + row] >> shift) & mask[first + row];
          }
        } else {
          for (Cell row = 0; row < rows; ++row) {
            found[row] = window(left[first + row], right[first + row], shift) & mask[first + row];
          }
        }
        // Which rows hold something cannot be foreseen: they are listed without a branch.
        std::array<Cell, kRows> filled;
        Cell count = 0;
        for (Cell row = 0; row < rows; ++row) {
          filled[count] = row;
          count += found[row] != 0 ? 1 : 0;
        }
        for (Cell i = 0; i < count; ++i) {
          const Cell row = filled[i];
          if (!visit(Row{found[row], begin / kBits + first + row, shift,
                         squared + std::size_t{first + row} * kBits})) {
            return;
          }
        }
      }
      mask += side;
      squared += side * kBits;
      begin += kBits << grid.column_bits_;
    }
  }

  friend class IndexedCells;

  std::vector<std::uint64_t> words_;
};

/// A fixed set of cells, numbered from 0 as they follow each other.
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

  /// Calls visit(number, squared distance) for the cells within the reach of `centre`; stops when
  /// it returns false.
  template <typename Visit>
  void forEachNear(const PixelGrid& grid, Cell centre, const Visit& visit) const {
    // A row of the disc has no gap: its cells in one word have numbers that follow each other.
    set_.forEachRowNear(grid, centre, [&](const CellSet::Row& row) {
      const auto visitBits = [&](std::uint64_t bits, Cell word) {
        const auto place = row.shift + static_cast<Cell>(__builtin_ctzll(bits));
        std::uint32_t number = index(word * CellSet::kBits + place % CellSet::kBits);
        for (; bits != 0; bits &= bits - 1, ++number) {
          if (!visit(number, row.squared[__builtin_ctzll(bits)])) {
            return false;
          }
        }
        return true;
      };
      const std::uint64_t left = row.bits & (~std::uint64_t{0} >> row.shift);
      const std::uint64_t right = row.bits ^ left;
      return (left == 0 || visitBits(left, row.word)) &&
             (right == 0 || visitBits(right, row.word + (Cell{1} << grid.column_bits_)));
    });
  }

 private:
  void number();

  CellSet set_;
  std::vector<Cell> cells_;           ///< by number
  std::vector<std::uint32_t> ranks_;  ///< cells of the set before each word
};

}  // namespace evolin
