// Claims about reading and writing numbers and lines of text.
#include "evolin_ros/base/text.h"

#include <gtest/gtest.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "evolin_ros/base/error.h"
#include "test/support/fuzz.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double fromBits(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

TEST(ParseDouble, ReadsDecimalNumbers) {
  EXPECT_EQ(parseDouble("1.5"), 1.5);
  EXPECT_EQ(parseDouble("-1.5e3"), -1500.0);
  EXPECT_EQ(parseDouble("+2E-2"), 0.02);
  EXPECT_EQ(parseDouble(".5"), 0.5);
  EXPECT_EQ(parseDouble("5."), 5.0);
  EXPECT_EQ(parseDouble(" \t7 "), 7.0);
  EXPECT_EQ(parseDouble("1.000000000000000000e+00"), 1.0);
  EXPECT_EQ(parseDouble("1e-400"), 0.0);
  EXPECT_TRUE(std::signbit(parseDouble("-0").value()));
}

TEST(ParseDouble, ReadsInfinityAndNan) {
  EXPECT_EQ(parseDouble("inf"), kInfinity);
  EXPECT_EQ(parseDouble("-Infinity"), -kInfinity);
  EXPECT_TRUE(std::isnan(parseDouble("nan").value()));
  EXPECT_TRUE(std::isnan(parseDouble("-NaN").value()));
}

TEST(ParseDouble, RefusesEverythingElse) {
  for (const std::string text :
       {"",       " ",       "abc",   "1,5",    "1 2", "0x10",  "1e",
        "1e+",    ".",       "-",     "+-1",    "--1", "1.2.3", "1f",
        "nan(1)", "infinit", "1e999", "-1e999", "1\n", "1_000", "\xC2\xA0"}) {
    EXPECT_FALSE(parseDouble(text)) << "'" << text << "'";
  }
  EXPECT_FALSE(parseDouble(std::string_view("1\0", 2)));
  EXPECT_FALSE(parseDouble(std::string_view("1\0002", 3)));
}

TEST(ParseDouble, ReadsOnlyItsOwnPartOfALargerText) {
  const std::string text = "12.75,9";
  EXPECT_EQ(parseDouble(std::string_view(text).substr(0, 4)), 12.7);
}

TEST(ParseDouble, IgnoresTheLocaleOfTheProcess) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  bool found = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ru_RU.UTF-8"}) {
    found = found || std::setlocale(LC_NUMERIC, name) != nullptr;
  }
  if (!found) GTEST_SKIP() << "no locale with a decimal comma is installed";
  const std::optional<double> value = parseDouble("1.5");
  const std::string text = formatDouble(0.1);
  std::setlocale(LC_NUMERIC, before.c_str());
  EXPECT_EQ(value, 1.5);
  EXPECT_EQ(text, "0.1");
}

TEST(ParseInteger, ReadsWholeNumbersToBothEnds) {
  EXPECT_EQ(parseInteger("42"), 42);
  EXPECT_EQ(parseInteger(" -7\t"), -7);
  EXPECT_EQ(parseInteger("+7"), 7);
  EXPECT_EQ(parseInteger("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(parseInteger("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
}

TEST(ParseInteger, RefusesEverythingElse) {
  for (const std::string text :
       {"", " ", "3.0", "3.5", "1e3", "abc", "0x10", "+-3", "++3", "+", "-", "9223372036854775808",
        "-9223372036854775809", "1 2", "1\n"}) {
    EXPECT_FALSE(parseInteger(text)) << "'" << text << "'";
  }
}

TEST(FormatDouble, WritesTheFewestDigits) {
  EXPECT_EQ(formatDouble(0), "0");
  EXPECT_EQ(formatDouble(-0.0), "-0");
  EXPECT_EQ(formatDouble(0.1), "0.1");
  EXPECT_EQ(formatDouble(-12.5), "-12.5");
  EXPECT_EQ(formatDouble(640), "640");
  EXPECT_EQ(formatDouble(0.0001), "0.0001");
  EXPECT_EQ(formatDouble(0.00001), "1e-5");
  EXPECT_EQ(formatDouble(1.5e-7), "1.5e-7");
  EXPECT_EQ(formatDouble(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(formatDouble(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(formatDouble(1e16), "10000000000000000");
  EXPECT_EQ(formatDouble(1e17), "1e+17");
  EXPECT_EQ(formatDouble(1e22), "1e+22");
  EXPECT_EQ(formatDouble(999999999999999.9), "999999999999999.9");
  EXPECT_EQ(formatDouble(5e-324), "5e-324");
  EXPECT_EQ(formatDouble(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
  EXPECT_EQ(formatDouble(kInfinity), "inf");
  EXPECT_EQ(formatDouble(-kInfinity), "-inf");
  EXPECT_EQ(formatDouble(std::nan("")), "nan");
  EXPECT_EQ(formatDouble(-std::nan("")), "nan");
}

TEST(FormatDouble, ReadsBackTheSame) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 100000; ++i) {
    const double value = fromBits(random());
    if (std::isnan(value)) continue;
    ASSERT_EQ(parseDouble(formatDouble(value)), value) << formatDouble(value);
  }
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    const double value = std::ldexp(1.0, exponent);
    ASSERT_EQ(parseDouble(formatDouble(value)), value) << exponent;
  }
}

#ifdef __cpp_lib_to_chars
std::size_t significantDigits(const std::string& text) {
  std::string digits;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c >= '0' && c <= '9') digits += c;
  }
  digits.erase(0, digits.find_first_not_of('0'));
  digits.erase(digits.find_last_not_of('0') + 1);
  return digits.size();
}

std::string shortestOfTheLibrary(double value) {
  std::string buffer(64, '\0');
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::scientific);
  buffer.resize(static_cast<std::size_t>(end.ptr - buffer.data()));
  return buffer;
}

TEST(FormatDouble, HasAsFewDigitsAsTheLibrarysShortestForm) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 50000; ++i) {
    const double value = fromBits(random());
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(significantDigits(formatDouble(value)),
              significantDigits(shortestOfTheLibrary(value)))
        << formatDouble(value);
  }
  // Powers of two have neighbours at two distances, subnormal numbers few digits.
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    const double value = std::ldexp(1.0, exponent);
    ASSERT_EQ(significantDigits(formatDouble(value)),
              significantDigits(shortestOfTheLibrary(value)))
        << formatDouble(value);
  }
}
#endif

TEST(Trim, TakesSpacesTabsAndCarriageReturns) {
  EXPECT_EQ(trim(" \ta b\r"), "a b");
  EXPECT_EQ(trim("\r \t"), "");
  EXPECT_EQ(trim(""), "");
  EXPECT_EQ(trim("x"), "x");
}

TEST(Split, KeepsEmptyPieces) {
  using Pieces = std::vector<std::string_view>;
  EXPECT_EQ(split("a,,b", ','), (Pieces{"a", "", "b"}));
  EXPECT_EQ(split("", ','), (Pieces{""}));
  EXPECT_EQ(split(",", ','), (Pieces{"", ""}));
  EXPECT_EQ(split("a b", ','), (Pieces{"a b"}));
}

TEST(SplitWords, HasNoEmptyPieces) {
  using Pieces = std::vector<std::string_view>;
  EXPECT_EQ(splitWords("  a\t b  "), (Pieces{"a", "b"}));
  EXPECT_EQ(splitWords(" \t "), Pieces{});
  EXPECT_EQ(splitWords(""), Pieces{});
  EXPECT_EQ(splitWords("one"), Pieces{"one"});
}

TEST(ReadLines, TakesBothLineEndsAndALastLineWithout) {
  const test::TemporaryFolder folder;
  using Lines = std::vector<std::string>;
  EXPECT_EQ(readLines(folder.write("a", "x\r\n\ny z")), (Lines{"x", "", "y z"}));
  EXPECT_EQ(readLines(folder.write("b", "x\n")), (Lines{"x"}));
  EXPECT_EQ(readLines(folder.write("c", "\n")), (Lines{""}));
  EXPECT_EQ(readLines(folder.write("d", "")), Lines{});
  EXPECT_EQ(readLines(folder.write("e", std::string("a\0b\n", 4))),
            (Lines{std::string("a\0b", 3)}));
}

TEST(ReadLines, LeavesOutAByteOrderMarkAtTheHeadOnly) {
  const test::TemporaryFolder folder;
  using Lines = std::vector<std::string>;
  EXPECT_EQ(readLines(folder.write("a",
                                   "\xEF\xBB\xBF"
                                   "1\n\xEF\xBB\xBF"
                                   "2")),
            (Lines{"1",
                   "\xEF\xBB\xBF"
                   "2"}));
  EXPECT_EQ(readLines(folder.write("b", "\xEF\xBB\xBF")), Lines{});
}

TEST(ReadLines, NamesWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  const std::filesystem::path missing = folder.path() / "missing.txt";
  try {
    readLines(missing);
    FAIL() << "a missing file was read";
  } catch (const ParseError& error) {
    EXPECT_EQ(error.file(), missing.string());
    EXPECT_EQ(error.line(), 0);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  EXPECT_THROW(readLines(folder.path()), ParseError);
}

TEST(ReadLines, GivesBackTheBytesOfAnyFile) {
  const test::TemporaryFolder folder;
  test::Fuzzer fuzzer(9);
  for (int i = 0; i < 300; ++i) {
    const std::string bytes = i == 0 ? std::string(3000000, 'x') : fuzzer.randomBytes(400);
    std::string joined;
    for (const std::string& line : readLines(folder.write("f", bytes))) joined += line + "\n";
    // What may go missing: the mark, carriage returns before line ends, the last line end.
    std::string expected = bytes.substr(0, 3) == "\xEF\xBB\xBF" ? bytes.substr(3) : bytes;
    for (std::size_t at = expected.find("\r\n"); at != std::string::npos;
         at = expected.find("\r\n")) {
      expected.erase(at, 1);
    }
    if (!expected.empty() && expected.back() != '\n') expected += '\n';
    if (bytes.find("\r\r\n") != std::string::npos) continue;  // only the last return is an end
    ASSERT_EQ(joined, expected);
  }
}

TEST(Quote, ShortensAndReplacesUnprintableBytes) {
  EXPECT_EQ(quote("abc"), "'abc'");
  EXPECT_EQ(quote(std::string("abc")), "'abc'");
  EXPECT_EQ(quote(""), "''");
  EXPECT_EQ(quote(std::string_view("a\0\n\x1B\x7F"
                                   "b",
                                   6)),
            "'a?\?\?\?b'");
  EXPECT_EQ(quote("gr\xC3\xBC\xC3\x9F"
                  "e"),
            "'gr\xC3\xBC\xC3\x9F"
            "e'");
  EXPECT_EQ(quote("\xC3(\xFF\x80"), "'?(?\?'");
  EXPECT_EQ(quote("\xED\xA0\x80"), "'?\?\?'");  // half of a surrogate pair
  EXPECT_EQ(quote("\xF0\x9F\x93\xB7"), "'\xF0\x9F\x93\xB7'");
  EXPECT_EQ(quote("\xC2\x9B"), "'?\?'");  // a terminal's control character
  const std::string longest = quote(std::string(1000000, 'y'));
  EXPECT_LE(longest.size(), 70U);
  EXPECT_EQ(longest.substr(longest.size() - 5), "y...'");
  std::string writable = "w";
  EXPECT_EQ(quote(writable), "'w'");
}

}  // namespace
}  // namespace evolin
