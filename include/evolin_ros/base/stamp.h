// Time stamps as whole nanoseconds, read from and written to text without loss.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace evolin {

/// Nanoseconds since the clock's origin (for recorded data usually the Unix epoch).
using Stamp = std::int64_t;

constexpr Stamp kNanosecondsPerSecond = 1000000000;

/// Reads decimal seconds ("1305031453.359684", "-0.5", "12"); digits past the ninth are rounded
/// half up. No exponent, no surrounding space. Empty when the text is not such a number or does not
/// fit.
std::optional<Stamp> parseStamp(std::string_view seconds);

/// Decimal seconds with at least six digits behind the point and at most nine, none of them
/// needless: 1305031453359684000 -> "1305031453.359684".
std::string formatStamp(Stamp stamp);

/// Seconds as floating point, for figures and differences; stamps of today lose about 0.2 us.
double toSeconds(Stamp stamp);

/// The nearest whole nanosecond; throws Error when seconds is not finite or does not fit.
Stamp fromSeconds(double seconds);

}  // namespace evolin
