// Pairs by chance are one to one, the same for a seed, and favour nobody.
#include "evolin_ros/association/random_associator.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

FrameLines frameOf(std::size_t lines, Stamp stamp) {
  FrameLines frame;
  frame.frame.stamp = stamp;
  frame.lines.resize(lines);
  return frame;
}

IndexPairs match(int seed, std::size_t first, std::size_t second, Stamp stamp) {
  RandomAssociator associator;
  associator.configure(YAML::Load("{seed: " + std::to_string(seed) + "}"));
  IndexPairs pairs;
  for (const LineMatch& pair : associator.match(frameOf(first, 7), frameOf(second, stamp))) {
    pairs.emplace_back(pair.first, pair.second);
  }
  return pairs;
}

TEST(RandomAssociator, GivesEveryLineOfTheSmallerFrameAPartner) {
  for (const auto& [first, second] :
       std::vector<std::pair<std::size_t, std::size_t>>{{5, 9}, {9, 5}, {4, 4}, {0, 3}, {3, 0}}) {
    const IndexPairs pairs = match(1, first, second, 8);
    ASSERT_EQ(pairs.size(), std::min(first, second));
    std::set<std::int64_t> of_first;
    std::set<std::int64_t> of_second;
    for (const auto& [i, j] : pairs) {
      EXPECT_LT(i, static_cast<std::int64_t>(first));
      EXPECT_LT(j, static_cast<std::int64_t>(second));
      of_first.insert(i);
      of_second.insert(j);
    }
    EXPECT_EQ(of_first.size(), pairs.size());
    EXPECT_EQ(of_second.size(), pairs.size());
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  }
}

TEST(RandomAssociator, TheSameSeedAndStampsGiveTheSamePairs) {
  EXPECT_EQ(match(1, 30, 40, 8), match(1, 30, 40, 8));
  EXPECT_NE(match(1, 30, 40, 8), match(2, 30, 40, 8));
  EXPECT_NE(match(1, 30, 40, 8), match(1, 30, 40, 9));
}

TEST(RandomAssociator, EveryPartnerIsEquallyLikely) {
  std::array<int, 4> counts = {};
  constexpr int kFrames = 4000;
  for (Stamp stamp = 0; stamp < kFrames; ++stamp) {
    ++counts.at(static_cast<std::size_t>(match(3, 2, 4, stamp).at(0).second));
  }
  for (const int count : counts) {
    EXPECT_NEAR(count, kFrames / 4, 5 * std::sqrt(kFrames * 0.25 * 0.75));
  }
}

TEST(RandomAssociator, WantsToBeConfigured) {
  RandomAssociator associator;
  EXPECT_THROW(associator.match(frameOf(1, 1), frameOf(1, 2)), Error);
  EXPECT_THROW(associator.configure(YAML::Load("{sead: 1}")), ConfigError);
}

}  // namespace
}  // namespace evolin
