// Hues by steps of the golden angle, at full saturation.
#include "evolin_ros/drawing/palette.h"

#include <cmath>

namespace evolin {

Colour colourOfNumber(std::int64_t number) {
  constexpr double kGoldenShare = 0.38196601125010515;  // of the circle: 137.5 degrees
  constexpr std::int64_t kPeriod = 1 << 20;             // keeps the product exact enough
  const auto small = static_cast<double>(((number % kPeriod) + kPeriod) % kPeriod);
  const double hue = std::fmod(small * kGoldenShare, 1.0) * 6;  // sixths of the circle
  // Each channel is full over a third of the circle and falls off to either side of it.
  const auto channel = [hue](double centre) {
    const double away = std::abs(std::remainder(hue - centre, 6.0));
    const double share = away <= 1 ? 1 : (away >= 2 ? 0 : 2 - away);
    return static_cast<std::uint8_t>(std::lround(255 * share));
  };
  return {channel(0), channel(2), channel(4)};
}

}  // namespace evolin
