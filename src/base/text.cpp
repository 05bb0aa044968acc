// Numbers and lines of text, read the same way under every locale of the process.
#include "evolin_ros/base/text.h"

#include <locale.h>
#include <stdlib.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kQuotedLength = 60;  // bytes; a line of a terminal holds it with a file name

bool isDigit(char c) { return c >= '0' && c <= '9'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view trimBlanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool equalsWithoutCase(std::string_view text, std::string_view lower_case) {
  if (text.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (lower(text[i]) != lower_case[i]) return false;
  }
  return true;
}

std::size_t skipDigits(std::string_view text, std::size_t at) {
  while (at < text.size() && isDigit(text[at])) ++at;
  return at;
}

/// digits [. digits] [e [sign] digits] with a digit on at least one side of the point; strtod would
/// also take hexadecimal numbers and stop early without complaint.
bool isDecimal(std::string_view text) {
  std::size_t at = skipDigits(text, 0);
  std::size_t digits = at;
  if (at < text.size() && text[at] == '.') {
    const std::size_t end = skipDigits(text, at + 1);
    digits += end - (at + 1);
    at = end;
  }
  if (digits == 0) return false;
  if (at < text.size() && lower(text[at]) == 'e') {
    ++at;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    const std::size_t end = skipDigits(text, at);
    if (end == at) return false;
    at = end;
  }
  return at == text.size();
}

/// strtod in the "C" locale: a host program may have set one whose decimal point is a comma.
double convertDecimal(const char* text) {
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", static_cast<locale_t>(nullptr));
  return strtod_l(text, nullptr, c_locale);
}

/// A positive finite number as 0.d1d2d3... * 10^point.
struct Decimal {
  std::string digits;
  int point = 0;
};

Decimal roundToDigits(double positive, int count) {
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*e", count - 1, positive);
  // Only digits are taken, so the decimal point of the process's locale does not matter.
  Decimal result;
  const char* at = buffer.data();
  for (; *at != 'e'; ++at) {
    if (isDigit(*at)) result.digits += *at;
  }
  result.point = std::atoi(at + 1) + 1;
  return result;
}

double valueOf(const Decimal& decimal) {
  return convertDecimal(("0." + decimal.digits + "e" + std::to_string(decimal.point)).c_str());
}

/// The next larger decimal of as many digits.
Decimal incremented(Decimal decimal) {
  std::size_t at = decimal.digits.size();
  while (at > 0 && decimal.digits[at - 1] == '9') decimal.digits[--at] = '0';
  if (at > 0) {
    ++decimal.digits[at - 1];
  } else {
    decimal.digits.insert(decimal.digits.begin(), '1');
    decimal.digits.pop_back();
    ++decimal.point;
  }
  return decimal;
}

Decimal shortestDecimal(double positive) {
  constexpr int kAlwaysEnough = std::numeric_limits<double>::max_digits10;
  // Fifteen digits never say more than a normal double holds, so a shorter text shows as trailing
  // zeros there; subnormal numbers hold fewer.
  const bool normal = positive >= std::numeric_limits<double>::min();
  int ignored_exponent = 0;
  const bool power_of_two = std::frexp(positive, &ignored_exponent) == 0.5;
  for (int count = normal ? std::numeric_limits<double>::digits10 : 1; count < kAlwaysEnough;
       ++count) {
    const Decimal nearest = roundToDigits(positive, count);
    if (valueOf(nearest) == positive) return nearest;
    // Below a power of two doubles lie twice as close as above it: the nearest decimal may read
    // back as the neighbour where the next one above would not.
    if (power_of_two) {
      const Decimal above = incremented(nearest);
      if (valueOf(above) == positive) return above;
    }
  }
  return roundToDigits(positive, kAlwaysEnough);
}

/// Length in bytes of the printable UTF-8 character at the head of `text`, 0 when there is none.
std::size_t printableLength(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  if (first >= 0xC2 && first <= 0xDF) {
    const bool control = first == 0xC2 && byte(1) < 0xA0;  // U+0080 to U+009F
    return continues(1) && !control ? 2 : 0;
  }
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool too_large = first == 0xF4 && byte(1) >= 0x90;
    return continues(1) && continues(2) && continues(3) && !overlong && !too_large ? 4 : 0;
  }
  return 0;
}

[[noreturn]] void throwUnreadable(const std::filesystem::path& file, int reason) {
  throw ParseError(
      file.string(), 0,
      "cannot be read: " + std::generic_category().message(reason) + "; expected a text file");
}

std::string readWhole(const std::filesystem::path& file) {
  // Opening a directory succeeds; only reading it fails, without a reason.
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throwUnreadable(file, EISDIR);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throwUnreadable(file, errno != 0 ? errno : EIO);
  std::string content;
  std::array<char, 1 << 16> buffer;
  while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
    content.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throwUnreadable(file, errno != 0 ? errno : EIO);
  return content;
}

}  // namespace

std::optional<double> parseDouble(std::string_view text) {
  text = trimBlanks(text);
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (negative || text.front() == '+')) text.remove_prefix(1);
  double magnitude = 0;
  if (isDecimal(text)) {
    magnitude = convertDecimal(std::string(text).c_str());
    if (std::isinf(magnitude)) return std::nullopt;
  } else if (equalsWithoutCase(text, "inf") || equalsWithoutCase(text, "infinity")) {
    magnitude = std::numeric_limits<double>::infinity();
  } else if (equalsWithoutCase(text, "nan")) {
    magnitude = std::numeric_limits<double>::quiet_NaN();
  } else {
    return std::nullopt;
  }
  return negative ? -magnitude : magnitude;
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  text = trimBlanks(text);
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (text.empty() || !isDigit(text.front())) return std::nullopt;
  }
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

std::string formatDouble(double value) {
  if (std::isnan(value)) return "nan";
  const std::string sign = std::signbit(value) ? "-" : "";
  if (std::isinf(value)) return sign + "inf";
  if (value == 0) return sign + "0";
  Decimal decimal = shortestDecimal(std::fabs(value));
  std::string& digits = decimal.digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  const int count = static_cast<int>(digits.size());
  const int point = decimal.point;
  constexpr int kMostLeadingZeros = 4;
  constexpr int kMostWholeDigits = 17;
  if (point <= -kMostLeadingZeros || point > kMostWholeDigits) {
    const int exponent = point - 1;
    const std::string tail = count > 1 ? "." + digits.substr(1) : "";
    return sign + digits.front() + tail + "e" + (exponent < 0 ? "-" : "+") +
           std::to_string(std::abs(exponent));
  }
  if (point <= 0) return sign + "0." + std::string(static_cast<std::size_t>(-point), '0') + digits;
  if (count <= point)
    return sign + digits + std::string(static_cast<std::size_t>(point - count), '0');
  const std::size_t whole = static_cast<std::size_t>(point);
  return sign + digits.substr(0, whole) + "." + digits.substr(whole);
}

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  while (true) {
    const std::size_t end = text.find(separator);
    pieces.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> splitWords(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t at = text.find_first_not_of(" \t");
  while (at != std::string_view::npos) {
    const std::size_t end = text.find_first_of(" \t", at);
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(" \t", end);
  }
  return words;
}

std::vector<std::string> readLines(const std::filesystem::path& file) {
  const std::string content = readWhole(file);
  std::string_view rest = content;
  // Editors on Windows put the mark there; it is no part of the first value.
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    rest.remove_prefix(kByteOrderMark.size());
  }
  std::vector<std::string> lines;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    if (end != std::string_view::npos && !line.empty() && line.back() == '\r') {
      line.remove_suffix(1);
    }
    lines.emplace_back(line);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return lines;
}

std::string quote(std::string_view text) {
  std::string result = "'";
  while (!text.empty()) {
    const std::size_t length = printableLength(text);
    if (result.size() + length > kQuotedLength) return result + "...'";
    // Messages end up in JSON and in ROS logs, which both want valid UTF-8.
    if (length == 0) {
      result += '?';
      text.remove_prefix(1);
    } else {
      result.append(text.substr(0, length));
      text.remove_prefix(length);
    }
  }
  return result + "'";
}

}  // namespace evolin
