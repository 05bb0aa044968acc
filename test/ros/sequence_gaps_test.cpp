// Counting lost messages by their running numbers.
#include "sequence_gaps.h"

#include <gtest/gtest.h>

#include <limits>

namespace evolin::ros_shell {
namespace {

sensor_msgs::Image numbered(std::uint32_t number) {
  sensor_msgs::Image image;
  image.header.seq = number;
  return image;
}

TEST(SequenceGaps, CountsWhatIsMissingBetweenTwoMessages) {
  SequenceGaps gaps;
  EXPECT_EQ(gaps.lostBefore(numbered(17)), 0U) << "nothing is known before the first";
  EXPECT_EQ(gaps.lostBefore(numbered(18)), 0U);
  EXPECT_EQ(gaps.lostBefore(numbered(20)), 1U);
  EXPECT_EQ(gaps.lostBefore(numbered(31)), 10U);
}

TEST(SequenceGaps, NumbersThatStandStillOrFallTellNothing) {
  SequenceGaps gaps;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(gaps.lostBefore(numbered(0)), 0U);
  EXPECT_EQ(gaps.lostBefore(numbered(100)), 99U);
  EXPECT_EQ(gaps.lostBefore(numbered(3)), 0U) << "a publisher that starts again";
  EXPECT_EQ(gaps.lostBefore(numbered(5)), 1U);
}

TEST(SequenceGaps, HoldsTheLargestNumbers) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  SequenceGaps gaps;
  gaps.lostBefore(numbered(0));
  EXPECT_EQ(gaps.lostBefore(numbered(kMost)), kMost - 1);
  EXPECT_EQ(gaps.lostBefore(numbered(0)), 0U) << "the numbers have come round";
}

}  // namespace
}  // namespace evolin::ros_shell
