// Picking of the few that may matter out of many bounds in single precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace evolin {

/// To `positions` (room for `end` - `begin`), by rising position, those in [begin, end) whose bound
/// is at most `limit`; a bound that is not a number is not. Returns their number.
inline std::size_t collectWithin(const float* bounds, std::size_t begin, std::size_t end,
                                 float limit, std::uint32_t* positions) {
  using Floats __attribute__((vector_size(16))) = float;
  using Bits __attribute__((vector_size(16))) = int;
  constexpr std::size_t kWidth = sizeof(Floats) / sizeof(float);
  constexpr std::size_t kBlock = 4 * kWidth;
  std::size_t found = 0;
  const auto pick = [&](std::size_t position) {
    positions[found] = static_cast<std::uint32_t>(position);
    found += bounds[position] <= limit ? 1 : 0;  // without a branch
  };
  const Floats limits = Floats{} + limit;
  std::size_t position = begin;
  for (; position + kBlock <= end; position += kBlock) {
    Bits any{};
    for (std::size_t part = 0; part < kBlock; part += kWidth) {
      Floats values;
      std::memcpy(&values, bounds + position + part, sizeof(values));
      any |= values <= limits;
    }
    if ((any[0] | any[1] | any[2] | any[3]) == 0) {
      continue;  // so it is of most blocks
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
      pick(position + i);
    }
  }
  for (; position < end; ++position) {
    pick(position);
  }
  return found;
}

}  // namespace evolin
