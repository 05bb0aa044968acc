// Numbering cells and listing a disc.
#include "pixel_grid.h"

#include <algorithm>

namespace evolin {

PixelGrid::PixelGrid(ImageSize size, int reach) : reach_(reach), stride_bits_(6) {
  const Cell width = static_cast<Cell>(size.width) + 2 * static_cast<Cell>(reach);
  const Cell height = static_cast<Cell>(size.height) + 2 * static_cast<Cell>(reach);
  while (width >> stride_bits_ != 0) {
    ++stride_bits_;
  }
  cells_ = static_cast<std::size_t>(height) << stride_bits_;
  for (int dy = -reach; dy <= reach; ++dy) {
    int half = 0;
    while ((half + 1) * (half + 1) + dy * dy <= reach * reach) {
      ++half;
    }
    const Cell row_offset = static_cast<Cell>(dy) << stride_bits_;  // wraps above the centre
    rows_.push_back({row_offset - static_cast<Cell>(half), 2 * static_cast<Cell>(half) + 1,
                     static_cast<std::uint32_t>(dy * dy)});
    for (int dx = -half; dx <= half; ++dx) {
      nearest_first_.push_back(
          {row_offset + static_cast<Cell>(dx), static_cast<std::uint32_t>(dx * dx + dy * dy)});
    }
  }
  std::stable_sort(nearest_first_.begin(), nearest_first_.end(),
                   [](const DiscCell& a, const DiscCell& b) { return a.squared < b.squared; });
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
    first += CellSet::kBits;
  }
}

}  // namespace evolin
