// Strict, locale-independent reading of numbers and lines of text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evolin {

/// The whole of `text` as a decimal floating-point number in the C locale ("nan", "inf" and their
/// signed forms are numbers too); surrounding spaces and tabs are allowed. Empty for anything else,
/// also for overflow.
std::optional<double> parseDouble(std::string_view text);

/// The whole of `text` as a decimal integer; surrounding spaces and tabs are allowed.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// Decimal text with the fewest significant digits that read back as the same double ("nan", "inf",
/// "-inf" for those; an exponent only below 1e-4 and from 1e17 on).
std::string formatDouble(double value);

/// Without leading and trailing spaces, tabs and carriage returns.
std::string_view trim(std::string_view text);

/// Pieces between `separator`; "a,,b" has three, "" has one (empty).
std::vector<std::string_view> split(std::string_view text, char separator);

/// Pieces between runs of spaces and tabs; none empty.
std::vector<std::string_view> splitWords(std::string_view text);

/// All lines of a text file without their ends ("\n" or "\r\n"); a last line without an end counts.
/// A UTF-8 byte order mark at the head is left out. Throws ParseError naming the file when it
/// cannot be read or is a directory.
std::vector<std::string> readLines(const std::filesystem::path& file);

/// Any text between single quotes, shortened to about 60 bytes, unprintable bytes replaced by '?'
/// (so always valid UTF-8): the value part of an error.
std::string quote(std::string_view text);

}  // namespace evolin
