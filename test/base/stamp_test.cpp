// Claims about time stamps: no digit is lost between text and nanoseconds.
#include "evolin_ros/base/stamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "evolin_ros/base/error.h"
#include "test/support/fuzz.h"

namespace evolin {
namespace {

constexpr Stamp kLargest = std::numeric_limits<Stamp>::max();
constexpr Stamp kSmallest = std::numeric_limits<Stamp>::min();

TEST(ParseStamp, KeepsEveryDigitOfTodaysStamps) {
  EXPECT_EQ(parseStamp("1305031453.359684"), 1305031453359684000);
  EXPECT_EQ(parseStamp("1305031453.123456789"), 1305031453123456789);
}

TEST(ParseStamp, ReadsWholeNegativeAndBareFractions) {
  EXPECT_EQ(parseStamp("12"), 12000000000);
  EXPECT_EQ(parseStamp("-0.5"), -500000000);
  EXPECT_EQ(parseStamp("-3.25"), -3250000000);
  EXPECT_EQ(parseStamp("0"), 0);
  EXPECT_EQ(parseStamp(".5"), 500000000);
  EXPECT_EQ(parseStamp("7."), 7000000000);
  EXPECT_EQ(parseStamp("00012.0"), 12000000000);
}

TEST(ParseStamp, RoundsTheTenthDigitHalfUp) {
  EXPECT_EQ(parseStamp("0.0000000004"), 0);
  EXPECT_EQ(parseStamp("0.0000000005"), 1);
  EXPECT_EQ(parseStamp("0.00000000049999"), 0);
  EXPECT_EQ(parseStamp("0.9999999995"), kNanosecondsPerSecond);
  // Up on the number line: towards zero for negative stamps, except past the half.
  EXPECT_EQ(parseStamp("-0.0000000005"), 0);
  EXPECT_EQ(parseStamp("-0.00000000050"), 0);
  EXPECT_EQ(parseStamp("-0.00000000051"), -1);
  EXPECT_EQ(parseStamp("-0.0000000006"), -1);
}

TEST(ParseStamp, ReachesBothEndsAndRefusesWhatDoesNotFit) {
  EXPECT_EQ(parseStamp("9223372036.854775807"), kLargest);
  EXPECT_EQ(parseStamp("-9223372036.854775808"), kSmallest);
  EXPECT_FALSE(parseStamp("9223372036.854775808"));
  EXPECT_FALSE(parseStamp("9223372036.8547758075"));
  EXPECT_FALSE(parseStamp("-9223372036.854775809"));
  EXPECT_FALSE(parseStamp("9223372037"));
  EXPECT_FALSE(parseStamp("99999999999999999999999999999999"));
}

TEST(ParseStamp, RefusesWhatIsNoDecimalNumber) {
  for (const std::string text : {"", "-", ".", "-.", "1e9", "+1", " 1", "1 ", "1.2.3", "abc", "1,5",
                                 "nan", "inf", "--1", "1.-2", "0x10"}) {
    EXPECT_FALSE(parseStamp(text)) << "'" << text << "'";
  }
  EXPECT_FALSE(parseStamp(std::string_view("1\0", 2)));
}

TEST(FormatStamp, WritesSixToNineDigits) {
  EXPECT_EQ(formatStamp(1305031453359684000), "1305031453.359684");
  EXPECT_EQ(formatStamp(1305031453359684001), "1305031453.359684001");
  EXPECT_EQ(formatStamp(1305031453359684010), "1305031453.35968401");
  EXPECT_EQ(formatStamp(0), "0.000000");
  EXPECT_EQ(formatStamp(1), "0.000000001");
  EXPECT_EQ(formatStamp(-500000000), "-0.500000");
  EXPECT_EQ(formatStamp(kLargest), "9223372036.854775807");
  EXPECT_EQ(formatStamp(kSmallest), "-9223372036.854775808");
}

TEST(FormatStamp, ReadsBackTheSame) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    // All magnitudes: a random number of low bits.
    const Stamp stamp = static_cast<Stamp>(random()) >> (random() % 63);
    ASSERT_EQ(parseStamp(formatStamp(stamp)), stamp);
  }
}

TEST(ToSeconds, IsTheNearestDoubleForPlainValues) {
  EXPECT_DOUBLE_EQ(toSeconds(1305031453359684000), 1305031453.359684);
  EXPECT_DOUBLE_EQ(toSeconds(-500000000), -0.5);
  EXPECT_EQ(toSeconds(0), 0.0);
}

TEST(FromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(fromSeconds(0.5), 500000000);
  EXPECT_EQ(fromSeconds(-0.5), -500000000);
  EXPECT_EQ(fromSeconds(1e-9), 1);
  EXPECT_EQ(fromSeconds(0.6e-9), 1);
  EXPECT_EQ(fromSeconds(0.4e-9), 0);
  EXPECT_EQ(fromSeconds(-0.6e-9), -1);
  EXPECT_EQ(fromSeconds(0.02), 20000000);
  EXPECT_EQ(fromSeconds(-3), -3000000000);
}

TEST(FromSeconds, ComesBackWithinADoublesPrecision) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 10000; ++i) {
    const Stamp stamp = static_cast<Stamp>(random()) >> (2 + random() % 60);
    const double seconds = toSeconds(stamp);
    const double precision = std::fabs(seconds) * 2.3e-16 * 1e9 + 1;
    ASSERT_LE(std::fabs(static_cast<double>(fromSeconds(seconds) - stamp)), precision) << stamp;
  }
}

TEST(FromSeconds, ThrowsForWhatIsNotFiniteOrDoesNotFit) {
  EXPECT_THROW(fromSeconds(std::nan("")), Error);
  EXPECT_THROW(fromSeconds(std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(fromSeconds(-std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(fromSeconds(9223372037.0), Error);
  EXPECT_THROW(fromSeconds(9223372036.9), Error);
  EXPECT_THROW(fromSeconds(-9223372036.9), Error);
  EXPECT_THROW(fromSeconds(-9223372038.0), Error);
  EXPECT_EQ(fromSeconds(9223372036.5), 9223372036500000000);
  EXPECT_EQ(fromSeconds(-9223372036.5), -9223372036500000000);
}

TEST(ParseStamp, TakesRandomTextWithoutHarm) {
  test::Fuzzer fuzzer(3);
  int numbers = 0;
  int refusals = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string text =
        i % 4 == 0 ? fuzzer.randomBytes(30) : fuzzer.damaged("1305031453.359684123");
    const std::optional<Stamp> stamp = parseStamp(text);
    ++(stamp ? numbers : refusals);
    if (stamp) {
      ASSERT_EQ(parseStamp(formatStamp(*stamp)), stamp) << text;
    }
  }
  EXPECT_GT(numbers, 1000);
  EXPECT_GT(refusals, 5000);
}

}  // namespace
}  // namespace evolin
