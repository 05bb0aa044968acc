// Numbering cells and listing a disc.
#include "pixel_grid.h"

#include <algorithm>

namespace evolin {

PixelGrid::PixelGrid(ImageSize size, int reach)
    : reach_(reach), side_(2 * static_cast<Cell>(reach) + 1) {
  while (static_cast<std::size_t>(size.height) + side_ - 1 > std::size_t{1} << column_bits_) {
    ++column_bits_;
  }
  // Two more than needed: a disc's last words, and the ones beside them.
  const std::size_t columns = (static_cast<std::size_t>(size.width) + side_) / kBits + 3;
  words_ = columns << column_bits_;
  const auto inside = [reach](int dx, int dy) { return dx * dx + dy * dy <= reach * reach; };
  for (int left = -reach; left <= reach; left += static_cast<int>(kBits)) {
    for (int dy = -reach; dy <= reach; ++dy) {
      std::uint64_t mask = 0;
      for (int bit = 0; bit < static_cast<int>(kBits); ++bit) {
        const int dx = left + bit;
        mask |= std::uint64_t{inside(dx, dy)} << static_cast<unsigned>(bit);
        squared_.push_back(static_cast<std::uint32_t>(dx * dx + dy * dy));
      }
      masks_.push_back(mask);
    }
  }
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      if (inside(dx, dy)) {
        nearest_first_.push_back({dx, dy});
      }
    }
  }
  std::stable_sort(nearest_first_.begin(), nearest_first_.end(),
                   [](const Offset& a, const Offset& b) {
                     return a.dx * a.dx + a.dy * a.dy < b.dx * b.dx + b.dy * b.dy;
                   });
}

IndexedCells::IndexedCells(const PixelGrid& grid, const Pixels& pixels) : set_(grid) {
  for (const Pixel& pixel : pixels) {
    set_.insert(grid.cell(pixel));
  }
  cells_.reserve(pixels.size());
  number();
}

IndexedCells::IndexedCells(const PixelGrid& grid, const std::vector<std::vector<Cell>>& lists)
    : set_(grid) {
  std::size_t count = 0;
  for (const std::vector<Cell>& cells : lists) {
    set_.insertAll(cells);
    count += cells.size();
  }
  cells_.reserve(count);
  number();
}

void IndexedCells::number() {
  ranks_.reserve(set_.words_.size());
  Cell first = 0;
  for (std::uint64_t word : set_.words_) {
    ranks_.push_back(static_cast<std::uint32_t>(cells_.size()));
    for (; word != 0; word &= word - 1) {
      cells_.push_back(first + static_cast<Cell>(__builtin_ctzll(word)));
    }
    first += PixelGrid::kBits;
  }
}

}  // namespace evolin
