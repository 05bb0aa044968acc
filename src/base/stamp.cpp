// Exact conversion between decimal seconds and whole nanoseconds.
#include "evolin_ros/base/stamp.h"

#include <cmath>
#include <limits>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

constexpr Stamp kLargest = std::numeric_limits<Stamp>::max();
constexpr Stamp kSmallest = std::numeric_limits<Stamp>::min();
constexpr std::uint64_t kMostSeconds = static_cast<std::uint64_t>(kLargest / kNanosecondsPerSecond);
constexpr int kFractionDigits = 9;
constexpr int kFewestFractionDigits = 6;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The digits behind the point as nanoseconds, from 0 to 1e9 (rounded up to a whole second).
std::uint64_t readFraction(std::string_view digits, bool negative) {
  std::uint64_t nanoseconds = 0;
  for (std::size_t i = 0; i < kFractionDigits; ++i) {
    const int digit = i < digits.size() ? digits[i] - '0' : 0;
    nanoseconds = nanoseconds * 10 + static_cast<std::uint64_t>(digit);
  }
  if (digits.size() <= kFractionDigits) return nanoseconds;
  const char next = digits[kFractionDigits];
  const bool more = digits.find_first_not_of('0', kFractionDigits + 1) != std::string_view::npos;
  // Half goes up on the number line, so towards zero when the stamp is negative.
  const bool up = next > '5' || (next == '5' && (more || !negative));
  return up ? nanoseconds + 1 : nanoseconds;
}

}  // namespace

std::optional<Stamp> parseStamp(std::string_view seconds) {
  const bool negative = !seconds.empty() && seconds.front() == '-';
  if (negative) seconds.remove_prefix(1);
  std::size_t digits = 0;
  std::uint64_t whole = 0;
  std::size_t at = 0;
  for (; at < seconds.size() && isDigit(seconds[at]); ++at, ++digits) {
    whole = whole * 10 + static_cast<std::uint64_t>(seconds[at] - '0');
    if (whole > kMostSeconds) return std::nullopt;
  }
  std::uint64_t fraction = 0;
  if (at < seconds.size()) {
    if (seconds[at] != '.') return std::nullopt;
    const std::string_view behind = seconds.substr(at + 1);
    for (const char c : behind) {
      if (!isDigit(c)) return std::nullopt;
    }
    digits += behind.size();
    fraction = readFraction(behind, negative);
  }
  if (digits == 0) return std::nullopt;
  // Below 2^64 in any case: kMostSeconds whole seconds and at most one more.
  const std::uint64_t magnitude =
      whole * static_cast<std::uint64_t>(kNanosecondsPerSecond) + fraction;
  const std::uint64_t limit = static_cast<std::uint64_t>(kLargest);
  if (negative && magnitude == limit + 1) return kSmallest;
  if (magnitude > limit) return std::nullopt;
  const Stamp value = static_cast<Stamp>(magnitude);
  return negative ? -value : value;
}

std::string formatStamp(Stamp stamp) {
  // The magnitude of the smallest stamp does not fit its own type.
  const std::uint64_t magnitude =
      stamp < 0 ? 0 - static_cast<std::uint64_t>(stamp) : static_cast<std::uint64_t>(stamp);
  const std::uint64_t second = static_cast<std::uint64_t>(kNanosecondsPerSecond);
  std::string fraction = std::to_string(magnitude % second);
  fraction.insert(0, kFractionDigits - fraction.size(), '0');
  while (fraction.size() > kFewestFractionDigits && fraction.back() == '0') fraction.pop_back();
  return (stamp < 0 ? "-" : "") + std::to_string(magnitude / second) + "." + fraction;
}

double toSeconds(Stamp stamp) {
  // The parts apart: a stamp of today has more digits than a double.
  const Stamp whole = stamp / kNanosecondsPerSecond;
  const Stamp rest = stamp % kNanosecondsPerSecond;
  return static_cast<double>(whole) + static_cast<double>(rest) * 1e-9;
}

Stamp fromSeconds(double seconds) {
  const double whole = std::floor(seconds);
  const double most = static_cast<double>(kMostSeconds);
  if (std::isfinite(seconds) && whole >= -most - 1 && whole <= most) {
    // A second up where negative, so that the product cannot leave the range.
    const Stamp step = whole < 0 ? 1 : 0;
    const Stamp base = (static_cast<Stamp>(whole) + step) * kNanosecondsPerSecond;
    const Stamp rest =
        static_cast<Stamp>(std::llround((seconds - whole) * 1e9)) - step * kNanosecondsPerSecond;
    if (rest <= 0 ? base >= kSmallest - rest : base <= kLargest - rest) return base + rest;
  }
  throw Error("time of " + formatDouble(seconds) + " s: expected a finite number between -" +
              std::to_string(kMostSeconds) + " and " + std::to_string(kMostSeconds) + " s");
}

}  // namespace evolin
