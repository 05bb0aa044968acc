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

TEST(DescriptorMatching, PairsNearestRowsAndGivesTheirDistance) {
  const cv::Mat first = (cv::Mat_<float>(2, 2) << 0, 0, 10, 10);
  const cv::Mat second = (cv::Mat_<float>(2, 2) << 10, 6, 3, 4);
  const LineMatches matches = matchDescriptors(first, second, true);
  EXPECT_EQ(pairs(matches), (IndexPairs{{0, 1}, {1, 0}}));
  EXPECT_FLOAT_EQ(matches[0].distance, 5.0F);
  EXPECT_FLOAT_EQ(matches[1].distance, 4.0F);
}

TEST(DescriptorMatching, CrossCheckDropsAOneSidedChoice) {
  const cv::Mat first = (cv::Mat_<float>(3, 1) << 0, 1, 9);
  const cv::Mat second = (cv::Mat_<float>(2, 1) << 1.25F, 8);
  EXPECT_EQ(pairs(matchDescriptors(first, second, true)), (IndexPairs{{1, 0}, {2, 1}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, false)), (IndexPairs{{0, 0}, {1, 0}, {2, 1}}));
}

TEST(DescriptorMatching, TakesTheLowestRowOnTies) {
  const cv::Mat first = (cv::Mat_<float>(2, 1) << 1, 1);
  const cv::Mat second = (cv::Mat_<float>(3, 1) << 5, 2, 0);
  EXPECT_EQ(pairs(matchDescriptors(first, second, true)), (IndexPairs{{0, 1}}));
  EXPECT_EQ(pairs(matchDescriptors(first, second, false)), (IndexPairs{{0, 1}, {1, 1}}));
}

TEST(DescriptorMatching, LeavesRowsWithNanOut) {
  const cv::Mat first = (cv::Mat_<float>(3, 2) << kNan, 0, 1, 1, 2, 2);
  const cv::Mat second = (cv::Mat_<float>(3, 2) << 1, 1, 2, kNan, 2, 3);
  EXPECT_EQ(pairs(matchDescriptors(first, second, true)), (IndexPairs{{1, 0}, {2, 2}}));
  EXPECT_TRUE(matchDescriptors(first.rowRange(0, 1), second, false).empty());
  EXPECT_TRUE(matchDescriptors(first, second.rowRange(1, 2), false).empty());
}

TEST(DescriptorMatching, MatchesNothingToNothing) {
  const cv::Mat some = (cv::Mat_<float>(1, 2) << 1, 1);
  EXPECT_TRUE(matchDescriptors(cv::Mat(), some, true).empty());
  EXPECT_TRUE(matchDescriptors(some, cv::Mat(), true).empty());
  EXPECT_TRUE(matchDescriptors(cv::Mat(0, 2, CV_32F), some, true).empty());
}

TEST(DescriptorMatching, RefusesOtherTypesAndWidths) {
  const cv::Mat floats = cv::Mat::zeros(2, 3, CV_32F);
  EXPECT_THROW(matchDescriptors(floats, cv::Mat::zeros(2, 4, CV_32F), true), Error);
  EXPECT_THROW(matchDescriptors(floats, cv::Mat::zeros(2, 3, CV_64F), true), Error);
  EXPECT_THROW(matchDescriptors(cv::Mat::zeros(2, 3, CV_8U), floats, true), Error);
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
  const LineMatches matches =
      matchBinaryDescriptors(bits({0xFFFF, 0x0101}), bits({0x0001, 0xFF0F, 0xF0F0}), true, 16);
  EXPECT_EQ(pairs(matches), (IndexPairs{{0, 1}, {1, 0}}));
  EXPECT_EQ(matches[0].distance, 4.0F);
  EXPECT_EQ(matches[1].distance, 1.0F);
}

TEST(BinaryDescriptorMatching, TakesTheLowestRowOnTiesAndChecksBothSides) {
  const BinaryDescriptors first = bits({0x0001, 0x0003});
  const BinaryDescriptors second = bits({0x0002, 0x0007, 0x0003});
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, true, 16)), (IndexPairs{{1, 2}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, false, 16)), (IndexPairs{{0, 2}, {1, 2}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(bits({5}), bits({1, 4, 7}), true, 16)),
            (IndexPairs{{0, 0}}));
}

TEST(BinaryDescriptorMatching, DropsPairsBeyondTheLimit) {
  const BinaryDescriptors first = bits({0x000F, 0xF000});
  const BinaryDescriptors second = bits({0x0003, 0xFF00});
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, true, 4)), (IndexPairs{{0, 0}, {1, 1}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, true, 3)), (IndexPairs{{0, 0}}));
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, true, 2)), (IndexPairs{{0, 0}}));
  EXPECT_TRUE(matchBinaryDescriptors(first, second, true, 1).empty());
}

TEST(BinaryDescriptorMatching, LeavesRowsThatAreNotValidOut) {
  BinaryDescriptors first = bits({1, 2, 3});
  BinaryDescriptors second = bits({1, 2, 3});
  first.valid[0] = 0;
  second.valid[2] = 0;
  // Row 2 would take its copy, and without it takes row 0, which its own copy left.
  EXPECT_EQ(pairs(matchBinaryDescriptors(first, second, true, 16)), (IndexPairs{{1, 1}, {2, 0}}));
  second.valid = {0, 0, 0};
  EXPECT_TRUE(matchBinaryDescriptors(first, second, false, 16).empty());
  EXPECT_TRUE(matchBinaryDescriptors(BinaryDescriptors(), first, false, 16).empty());
}

TEST(BinaryDescriptorMatching, RefusesOtherTypesWidthsAndMarks) {
  const BinaryDescriptors good = bits({1, 2});
  BinaryDescriptors bad = good;
  bad.valid.pop_back();
  EXPECT_THROW(matchBinaryDescriptors(good, bad, true, 16), Error);
  bad = good;
  bad.bits = cv::Mat::zeros(2, 3, CV_8U);
  EXPECT_THROW(matchBinaryDescriptors(good, bad, true, 16), Error);
  bad.bits = cv::Mat::zeros(2, 2, CV_32F);
  EXPECT_THROW(matchBinaryDescriptors(bad, good, true, 16), Error);
}

}  // namespace
}  // namespace evolin
