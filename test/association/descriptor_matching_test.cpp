// Nearest neighbours of small matrices worked out by hand.
#include "evolin_ros/association/descriptor_matching.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

IndexPairs pairs(const LineMatches& matches) {
  IndexPairs result;
  for (const LineMatch& match : matches) {
    result.emplace_back(match.first, match.second);
  }
  return result;
}

MatchingRules rules(bool cross_check,
                    double max_distance = std::numeric_limits<double>::infinity()) {
  MatchingRules result;
  result.cross_check = cross_check;
  result.max_distance = max_distance;
  return result;
}

MatchingRules withRatio(bool cross_check, double max_ratio) {
  MatchingRules result = rules(cross_check);
  result.max_ratio = max_ratio;
  return result;
}

TEST(DescriptorMatching, PairsNearestRowsAndGivesTheirDistance) {
  const cv::Mat first = (cv::Mat_<float>(2, 2) << 0, 0, 10, 10);
  const cv::Mat second = (cv::Mat_<float>(2, 2) << 10, 6, 3, 4);
  const LineMatches matches = matchDescriptors(first, second, rules(true));
  EXPECT_EQ(pairs(matches), (IndexPairs{{0, 1}, {1, 0}}));
  EXPECT_FLOAT_EQ(matches[0].distance, 5.0F);
  EXPECT_FLOAT_EQ(matches[1].distance, 4.0F);
}

TEST(DescriptorMatching, CrossCheckDropsAOneSidedChoice) {
  const cv::Mat first = (cv::Mat_<float>(3, 1) << 0, 1, 9);
  const cv::Mat second = (cv::Mat_<float>(2, 1) << 1.25F, 8);
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(true))), (IndexPairs{{1, 0}, {2, 1}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(false))),
            (IndexPairs{{0, 0}, {1, 0}, {2, 1}}));
}

TEST(DescriptorMatching, TakesTheLowestRowOnTies) {
  const cv::Mat first = (cv::Mat_<float>(2, 1) << 1, 1);
  const cv::Mat second = (cv::Mat_<float>(3, 1) << 5, 2, 0);
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(true))), (IndexPairs{{0, 1}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(false))), (IndexPairs{{0, 1}, {1, 1}}));
}

TEST(DescriptorMatching, DropsPairsBeyondTheLimit) {
  const cv::Mat first = (cv::Mat_<float>(2, 2) << 0, 0, 10, 10);
  const cv::Mat second = (cv::Mat_<float>(2, 2) << 10, 6, 3, 4);
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(true, 5))), (IndexPairs{{0, 1}, {1, 0}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(true, 4.9))), (IndexPairs{{1, 0}}));
  EXPECT_TRUE(matchDescriptors(first, second, rules(true, 3.9)).empty());
}

// 0 is 2 from its nearest and 4 from the next; 10 is 1 and 6 from them. Seen from the second side 2
// has 0 at 2 and 10 at 8, 4 has 0 at 4 and 10 at 6, 9 has 10 at 1.
TEST(DescriptorMatching, AsksForADistanceToTheSecondNearest) {
  const cv::Mat first = (cv::Mat_<float>(2, 1) << 0, 10);
  const cv::Mat second = (cv::Mat_<float>(3, 1) << 2, 4, 9);
  for (const bool cross_check : {false, true}) {
    EXPECT_EQ(pairs(matchDescriptors(first, second, withRatio(cross_check, 0.51))),
              (IndexPairs{{0, 0}, {1, 2}}));
    EXPECT_EQ(pairs(matchDescriptors(first, second, withRatio(cross_check, 0.5))),
              (IndexPairs{{1, 2}}));
    EXPECT_TRUE(matchDescriptors(first, second, withRatio(cross_check, 0.1)).empty());
  }
}

TEST(DescriptorMatching, AsksBothSidesForTheSecondNearestWithCrossCheckAlone) {
  const cv::Mat first = (cv::Mat_<float>(2, 1) << 0, 1);
  const cv::Mat second = (cv::Mat_<float>(1, 1) << 0.4F);  // 0.4 from one and 0.6 from the other
  EXPECT_TRUE(matchDescriptors(first, second, withRatio(true, 0.6)).empty());
  EXPECT_EQ(pairs(matchDescriptors(first, second, withRatio(true, 0.7))), (IndexPairs{{0, 0}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, withRatio(false, 0.6))),
            (IndexPairs{{0, 0}, {1, 0}}));
}

TEST(DescriptorMatching, DropsTwinsByTheRatioAndKeepsThemWithoutIt) {
  const cv::Mat first = (cv::Mat_<float>(1, 1) << 1);
  const cv::Mat second = (cv::Mat_<float>(2, 1) << 1, 1);
  EXPECT_TRUE(matchDescriptors(first, second, withRatio(false, 0.99)).empty());
  EXPECT_EQ(pairs(matchDescriptors(first, second, withRatio(false, 1))), (IndexPairs{{0, 0}}));
}

TEST(DescriptorMatching, LooksForTheNearestAmongThoseThatMayMatch) {
  const cv::Mat first = (cv::Mat_<float>(2, 1) << 0, 10);
  const cv::Mat second = (cv::Mat_<float>(3, 1) << 2, 4, 9);
  MatchingRules gated = withRatio(true, 0.5);
  gated.may_match = [](std::size_t i, std::size_t j) { return i != 0 || j == 1; };
  // 0 has no other than 4 now, but 4 has 0 at 4 and 10 at 6.
  EXPECT_EQ(pairs(matchDescriptors(first, second, gated)), (IndexPairs{{1, 2}}));
  gated.max_ratio = 1;
  EXPECT_EQ(pairs(matchDescriptors(first, second, gated)), (IndexPairs{{0, 1}, {1, 2}}));
  gated.may_match = [](std::size_t, std::size_t) { return false; };
  EXPECT_TRUE(matchDescriptors(first, second, gated).empty());
}

// The places are those of the caller, also where rows are left out.
TEST(DescriptorMatching, AsksWhetherRowsMayMatchByTheirPlaceInTheMatrix) {
  const cv::Mat first = (cv::Mat_<float>(3, 1) << kNan, 1, 2);
  const cv::Mat second = (cv::Mat_<float>(3, 1) << kNan, 1, 2);
  MatchingRules gated = rules(true);
  gated.may_match = [](std::size_t i, std::size_t j) { return i + j == 3; };
  EXPECT_EQ(pairs(matchDescriptors(first, second, gated)), (IndexPairs{{1, 2}, {2, 1}}));
}

// 5,000 rows by 5,000: more pairs than are kept at a time.
TEST(DescriptorMatching, PairsManyRowsAsItPairsFew) {
  constexpr int kRows = 5000;
  cv::Mat first(kRows, 2, CV_32F);
  cv::Mat second(kRows, 2, CV_32F);
  for (int i = 0; i < kRows; ++i) {
    first.at<float>(i, 0) = static_cast<float>(i % 100);
    first.at<float>(i, 1) = static_cast<float>(i / 100);
    first.row(i).copyTo(second.row(kRows - 1 - i));
  }
  const LineMatches matches = matchDescriptors(first, second, {});
  ASSERT_EQ(matches.size(), static_cast<std::size_t>(kRows));
  for (const LineMatch& match : matches) {
    ASSERT_EQ(match.first + match.second, static_cast<unsigned>(kRows - 1));
    ASSERT_EQ(match.distance, 0);
  }
}

TEST(DescriptorMatching, LeavesRowsWithNanOut) {
  const cv::Mat first = (cv::Mat_<float>(3, 2) << kNan, 0, 1, 1, 2, 2);
  const cv::Mat second = (cv::Mat_<float>(3, 2) << 1, 1, 2, kNan, 2, 3);
  EXPECT_EQ(pairs(matchDescriptors(first, second, rules(true))), (IndexPairs{{1, 0}, {2, 2}}));
  EXPECT_TRUE(matchDescriptors(first.rowRange(0, 1), second, rules(false)).empty());
  EXPECT_TRUE(matchDescriptors(first, second.rowRange(1, 2), rules(false)).empty());
}

TEST(DescriptorMatching, MatchesNothingToNothing) {
  const cv::Mat some = (cv::Mat_<float>(1, 2) << 1, 1);
  EXPECT_TRUE(matchDescriptors(cv::Mat(), some, rules(true)).empty());
  EXPECT_TRUE(matchDescriptors(some, cv::Mat(), rules(true)).empty());
  EXPECT_TRUE(matchDescriptors(cv::Mat(0, 2, CV_32F), some, rules(true)).empty());
}

TEST(DescriptorMatching, RefusesOtherTypesAndWidths) {
  const cv::Mat floats = cv::Mat::zeros(2, 3, CV_32F);
  EXPECT_THROW(matchDescriptors(floats, cv::Mat::zeros(2, 4, CV_32F), rules(true)), Error);
  EXPECT_THROW(matchDescriptors(floats, cv::Mat::zeros(2, 3, CV_64F), rules(true)), Error);
  EXPECT_THROW(matchDescriptors(cv::Mat::zeros(2, 3, CV_8U), floats, rules(true)), Error);
}

// Two bytes a row.
BinaryDescriptors bits(const std::vector<int>& words) {
  BinaryDescriptors descriptors;
  descriptors.bits.create(static_cast<int>(words.size()), 2, CV_8U);
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::uint8_t* const row = descriptors.bits.ptr<std::uint8_t>(static_cast<int>(i));
    row[0] = static_cast<std::uint8_t>(words[i] >> 8);
    row[1] = static_cast<std::uint8_t>(words[i] & 0xFF);
  }
  descriptors.valid.assign(words.size(), 1);
  return descriptors;
}

TEST(BinaryDescriptorMatching, CountsTheBitsThatDiffer) {
  const LineMatches matches = matchBinaryDescriptors(
      bits({0xFFFF, 0x0101}), bits({0x0001, 0xFF0F, 0xF0F0}), rules(true, 16));
  EXPECT_EQ(pairs(matches), (IndexPairs{{0, 1}, {1, 0}}));
  EXPECT_EQ(matches[0].distance, 4.0F);
  EXPECT_EQ(matches[1].distance, 1.0F);
}

TEST(BinaryDescriptorMatching, TakesTheLowestRowOnTiesAndChecksBothSides) {
  const BinaryDescriptors first = bits({0x0001, 0x0003});
  const BinaryDescriptors second = bits({0x0002, 0x0007, 0x0003});
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(true, 16))), (IndexPairs{{1, 2}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(false, 16))),
            (IndexPairs{{0, 2}, {1, 2}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(bits({5}), bits({1, 4, 7}), rules(true, 16))),
            (IndexPairs{{0, 0}}));
}

TEST(BinaryDescriptorMatching, DropsPairsBeyondTheLimit) {
  const BinaryDescriptors first = bits({0x000F, 0xF000});
  const BinaryDescriptors second = bits({0x0003, 0xFF00});
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(true, 4))),
            (IndexPairs{{0, 0}, {1, 1}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(true, 3))), (IndexPairs{{0, 0}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(true, 2))), (IndexPairs{{0, 0}}));
  EXPECT_TRUE(matchBinaryDescriptors(first, second, rules(true, 1)).empty());
}

TEST(BinaryDescriptorMatching, KeepsToRatioAndToThoseThatMayMatch) {
  const BinaryDescriptors first = bits({0x0000, 0x00FF});
  const BinaryDescriptors second = bits({0x0003, 0x001F, 0x00FE});  // 2, 5, 7 and 6, 3, 1 bits
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, withRatio(true, 0.41))),
            (IndexPairs{{0, 0}, {1, 2}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, withRatio(true, 0.4))),
            (IndexPairs{{1, 2}}));
  MatchingRules gated = rules(true);
  gated.may_match = [](std::size_t i, std::size_t j) { return i != 0 || j != 0; };
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, gated)), (IndexPairs{{1, 2}}));
  gated.cross_check = false;
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, gated)), (IndexPairs{{0, 1}, {1, 2}}));
}

TEST(BinaryDescriptorMatching, LeavesRowsThatAreNotValidOut) {
  BinaryDescriptors first = bits({1, 2, 3});
  BinaryDescriptors second = bits({1, 2, 3});
  first.valid[0] = 0;
  second.valid[2] = 0;
  // Row 2 would take its copy, and without it takes row 0, which its own copy left.
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, rules(true, 16))),
            (IndexPairs{{1, 1}, {2, 0}}));
  second.valid = {0, 0, 0};
  EXPECT_TRUE(matchBinaryDescriptors(first, second, rules(false, 16)).empty());
  EXPECT_TRUE(matchBinaryDescriptors(BinaryDescriptors(), first, rules(false, 16)).empty());
}

TEST(BinaryDescriptorMatching, RefusesOtherTypesWidthsAndMarks) {
  const BinaryDescriptors good = bits({1, 2});
  BinaryDescriptors bad = good;
  bad.valid.pop_back();
  EXPECT_THROW(matchBinaryDescriptors(good, bad, rules(true, 16)), Error);
  bad = good;
  bad.bits = cv::Mat::zeros(2, 3, CV_8U);
  EXPECT_THROW(matchBinaryDescriptors(good, bad, rules(true, 16)), Error);
  bad.bits = cv::Mat::zeros(2, 2, CV_32F);
  EXPECT_THROW(matchBinaryDescriptors(bad, good, rules(true, 16)), Error);
}

}  // namespace
}  // namespace evolin
