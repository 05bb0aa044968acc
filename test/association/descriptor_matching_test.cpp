// Nearest neighbours of small matrices worked out by hand.
#include "evolin_ros/association/descriptor_matching.h"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace evolin
