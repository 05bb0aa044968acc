// Where edge drawing begins: pixels that rise above their neighbours across the edge.
#pragma once

#include <algorithm>
#include <cstdint>

namespace evolin {

/// Sets flags[x] for x in [first, last) to 1 where the pixel of GradientMaps::strength rises by at
/// least `rise` above both neighbours across its edge, and has strength at all; else to 0. `above`,
/// `here` and `below` are rows of it that have a pixel on either side of that range.
inline void flagRidge(const std::uint16_t* above, const std::uint16_t* here,
                      const std::uint16_t* below, int first, int last, std::int16_t rise,
                      std::uint8_t* flags) {
  for (int x = first; x < last; ++x) {
    // Both pairs of neighbours, then a choice: so the loop has no branch and vectorises.
    const auto beside = static_cast<std::int16_t>(std::max(here[x - 1], here[x + 1]) >> 1U);
    const auto across = static_cast<std::int16_t>(std::max(above[x], below[x]) >> 1U);
    const auto value = static_cast<std::int16_t>(here[x] >> 1U);
    const std::int16_t other = (here[x] & 1U) != 0 ? beside : across;
    const auto above_other = static_cast<std::int16_t>(value - other);
    flags[x] = static_cast<std::uint8_t>((value > 0) & (above_other >= rise));
  }
}

}  // namespace evolin
