// Colours that stay apart for colour-blind eyes, and one for every number.
#pragma once

#include <cstdint>

namespace evolin {

/// sRGB.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

constexpr bool operator==(const Colour& a, const Colour& b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

/// Blue against orange is told apart with every kind of colour vision; misses are dashed besides,
/// so that they need no colour at all.
namespace palette {
constexpr Colour kTruePositive{70, 175, 255};
constexpr Colour kFalsePositive{255, 145, 0};
constexpr Colour kMissed{255, 255, 255};
constexpr Colour kPlain{165, 165, 165};  ///< a line without a verdict
constexpr Colour kPaper{24, 26, 30};     ///< the margin
constexpr Colour kInk{228, 228, 228};
constexpr Colour kFaintInk{150, 150, 150};
}  // namespace palette

/// The same colour for the same number; neighbouring numbers have hues far apart.
Colour colourOfNumber(std::int64_t number);

}  // namespace evolin
