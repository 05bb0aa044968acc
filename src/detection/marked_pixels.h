// Visiting the few pixels of a row that are marked.
#pragma once

#include <cstdint>
#include <cstring>

namespace evolin {

/// Calls `visit(x)` for each x of first, first + interval, ... below `last` where row[x] is not 0
/// when its turn comes; `interval` is at least 1.
template <typename Visit>
void visitMarked(const std::uint8_t* row, int first, int last, int interval, Visit visit) {
  constexpr int kAtOnce = 8;
  // To the last position of a block of kAtOnce that would be looked at.
  const int skip = (kAtOnce - 1) / interval * interval;
  for (int x = first; x < last; x += interval) {
    if (x + kAtOnce <= last) {
      std::uint64_t block = 0;
      std::memcpy(&block, row + x, kAtOnce);
      if (block == 0) {
        x += skip;
        continue;
      }
    }
    if (row[x] != 0) {
      visit(x);
    }
  }
}

}  // namespace evolin
