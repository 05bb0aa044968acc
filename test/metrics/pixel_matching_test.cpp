// Counts of matched pixels: by hand, on layouts where the largest matching is not the cheapest, and
// against a plain solver.
#include "evolin_ros/metrics/pixel_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "test/metrics/pixel_layouts.h"
#include "test/metrics/slow_matching.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::countMatched;
using test::countMost;
using test::countSlowly;
using test::PixelLayout;
using Counts = std::vector<std::size_t>;

constexpr ImageSize kSize{640, 480};

TEST(PixelMatchingRule, IsAHundredthOfTheDiagonalRoundedUpAndTheDiagonal) {
  EXPECT_EQ(pixelMatchingRule(kSize).reach, 8);
  EXPECT_EQ(pixelMatchingRule(kSize).free_cost, 800);
  EXPECT_EQ(pixelMatchingRule({60, 80}).reach, 1);
  EXPECT_EQ(pixelMatchingRule({61, 80}).reach, 2);
  EXPECT_DOUBLE_EQ(pixelMatchingRule({1, 1}).free_cost, std::sqrt(2.0));
  for (const ImageSize size : {ImageSize{0, 3}, ImageSize{3, -1}}) {
    test::expectError([&] { pixelMatchingRule(size); }, {"positive size"});
  }
}

TEST(PixelMatching, ReachIsEuclideanAndInclusive) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  const Pixels truth = {{100, 100}};
  const auto matched = [&](Pixel predicted) {
    return countMatchedPixels(kSize, rule, truth, {{predicted}})[0];
  };
  for (int dy = -10; dy <= 10; ++dy) {
    for (int dx = -10; dx <= 10; ++dx) {
      EXPECT_EQ(matched({100 + dx, 100 + dy}), dx * dx + dy * dy <= 64 ? 1U : 0U)
          << dx << "," << dy;
    }
  }
}

TEST(PixelMatching, WorksInTheCornersOfTheImage) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  const Pixels corners = {{0, 0}, {639, 0}, {0, 479}, {639, 479}};
  EXPECT_EQ(countMatchedPixels(kSize, rule, corners, {corners}), Counts{4});
  EXPECT_EQ(countMatchedPixels(kSize, rule, corners, {{{0, 8}, {631, 0}, {8, 479}, {639, 471}}}),
            Counts{4});
  // Neighbours in memory are none in the image.
  EXPECT_EQ(countMatchedPixels(kSize, rule, {{0, 1}}, {{{639, 0}}}), Counts{0});
  EXPECT_EQ(countMatchedPixels({1, 1}, pixelMatchingRule({1, 1}), {{0, 0}}, {{{0, 0}}}), Counts{1});
}

TEST(PixelMatching, EachPixelMatchesOnce) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  EXPECT_EQ(countMatchedPixels(kSize, rule, {{9, 9}}, {{{8, 9}, {9, 9}, {10, 9}}}), Counts{1});
  EXPECT_EQ(countMatchedPixels(kSize, rule, {{8, 9}, {9, 9}, {10, 9}}, {{{9, 9}}}), Counts{1});
  // The middle one must give way to the outer ones.
  EXPECT_EQ(countMatchedPixels(kSize, rule, {{0, 0}, {8, 0}}, {{{8, 0}, {16, 0}}}), Counts{2});
}

TEST(PixelMatching, NothingMatchesNothing) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  const Pixels some = {{3, 3}};
  EXPECT_EQ(countMatchedPixels(kSize, rule, {}, {some}), Counts{0});
  EXPECT_EQ(countMatchedPixels(kSize, rule, some, {{}, {}}), (Counts{0, 0}));
  EXPECT_EQ(countMatchedPixels(kSize, rule, some, {}), Counts{});
  EXPECT_EQ(countMatchedPixels(kSize, rule, some, {{}, some, {}}), (Counts{0, 1, 1}));
}

TEST(PixelMatching, ShiftsAChainOnlyWhileThatCostsLessThanADiagonal) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  // n links: n + 1 shifts of 8 pixels and 1e-6 each, and n pairs of 1e-6 before. 99 shifts cost
  // 792, 100 cost 800.000001.
  EXPECT_EQ(countMatched(test::shiftedChain(kSize, rule, 98)), (Counts{98, 99}));
  EXPECT_EQ(countMatched(test::shiftedChain(kSize, rule, 99)), (Counts{99, 99}));
  EXPECT_EQ(countMatched(test::shiftedChain(kSize, rule, 600)), (Counts{600, 600}));
  // All in one level: the same optimum without any history.
  PixelLayout chain = test::shiftedChain(kSize, rule, 99);
  chain.added[0].push_back(chain.added[1][0]);
  chain.added.pop_back();
  EXPECT_EQ(countMatched(chain), Counts{99});
}

TEST(PixelMatching, TheCostOfAPairTipsATie) {
  // One shift of exactly the free cost, plus 1e-6: it does not pay.
  const Pixels truth = {{0, 0}};
  EXPECT_EQ(countMatchedPixels({9, 9}, {2, 2.0}, truth, {{{2, 0}}}), Counts{0});
  EXPECT_EQ(countMatchedPixels({9, 9}, {2, 2.00001}, truth, {{{2, 0}}}), Counts{1});
}

TEST(PixelMatching, AStrongerLevelMayCloseWhatAnEarlierOneLeftOpen) {
  // The chain's first pixel stays free until a predicted pixel beside it turns up.
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  PixelLayout chain = test::shiftedChain(kSize, rule, 150);
  chain.added.push_back({{0, 1}});
  EXPECT_EQ(countMatched(chain), (Counts{150, 150, 151}));
}

TEST(PixelMatching, CombsGiveUpTheTeethThatAreTooDear) {
  const PixelMatchingRule rule = {4, 45.0};
  // A tip reaches the spine's free end over 6 + 1 shifts of 4 from the first tooth, over more
  // from the others: 8 more a tooth.
  const PixelLayout layout = test::comb({200, 100}, rule, 12, 6);
  const Counts expected = countSlowly(layout);
  EXPECT_EQ(countMatched(layout), expected);
  EXPECT_EQ(countMost(layout).back(), expected.back());
  PixelLayout late = layout;  // the first teeth's tips never come
  late.added[1].clear();
  late.added[2].clear();
  late.added[3].clear();
  EXPECT_EQ(countMatched(late), countSlowly(late));
  EXPECT_LT(countSlowly(late).back(), countMost(late).back());
}

TEST(PixelMatching, LaddersAgreeWithThePlainSolver) {
  for (const double free_cost : {2.5, 6.0, 14.0, 60.0}) {
    for (const int rungs : {3, 9}) {
      const PixelLayout layout = test::ladder({60, 20}, {4, free_cost}, rungs);
      EXPECT_EQ(countMatched(layout), countSlowly(layout)) << free_cost << ", " << rungs;
    }
  }
}

TEST(PixelMatching, RandomCloudsAgreeWithThePlainSolver) {
  test::RandomLines random(11);
  int below_most = 0;
  for (int round = 0; round < 300; ++round) {
    const int reach = 1 + static_cast<int>(random.index(4));
    const PixelLayout layout =
        test::cloud(&random, {12 + static_cast<int>(random.index(9)), 8}, reach,
                    random.uniform(0.5, 5.0 * reach), random.uniform(0.1, 0.7),
                    random.uniform(0.1, 0.7), 1 + random.index(4));
    const Counts expected = countSlowly(layout);
    ASSERT_EQ(countMatched(layout), expected) << "round " << round;
    below_most += expected == countMost(layout) ? 0 : 1;
  }
  EXPECT_GT(below_most, 20) << "too few inputs on which cost matters";
}

TEST(PixelMatching, DriftingWalksAgreeWithThePlainSolver) {
  test::RandomLines random(12);
  int below_most = 0;
  for (int round = 0; round < 120; ++round) {
    const int reach = 2 + static_cast<int>(random.index(5));
    const PixelLayout layout =
        test::driftingWalks(&random, {90, 70}, reach, random.uniform(2.0, 12.0) * reach, 4, 25);
    const Counts expected = countSlowly(layout);
    ASSERT_EQ(countMatched(layout), expected) << "round " << round;
    below_most += expected == countMost(layout) ? 0 : 1;
  }
  EXPECT_GT(below_most, 10) << "too few inputs on which cost matters";
}

TEST(PixelMatching, OrderOfPixelsDoesNotMatter) {
  test::RandomLines random(13);
  for (int round = 0; round < 40; ++round) {
    PixelLayout layout = test::driftingWalks(&random, {120, 90}, 5, 40, 6, 40);
    const Counts counts = countMatched(layout);
    random.shuffle(&layout.ground_truth);
    for (Pixels& level : layout.added) {
      random.shuffle(&level);
    }
    EXPECT_EQ(countMatched(layout), counts);
  }
}

TEST(PixelMatching, LevelsAreSnapshotsOfTheirUnions) {
  test::RandomLines random(14);
  for (int round = 0; round < 40; ++round) {
    const PixelLayout layout = test::cloud(&random, {60, 40}, 3, 9, 0.4, 0.4, 5);
    const Counts counts = countMatched(layout);
    PixelLayout together = layout;
    together.added = {{}};
    for (std::size_t level = 0; level < layout.added.size(); ++level) {
      together.added[0].insert(together.added[0].end(), layout.added[level].begin(),
                               layout.added[level].end());
      EXPECT_EQ(countMatched(together), Counts{counts[level]});
      EXPECT_GE(counts[level], level == 0 ? 0 : counts[level - 1]);
    }
  }
}

TEST(PixelMatching, NeverFewerPairsForAHigherFreeCost) {
  test::RandomLines random(15);
  for (int round = 0; round < 20; ++round) {
    PixelLayout layout = test::driftingWalks(&random, {120, 90}, 5, 1, 6, 40);
    Counts before(layout.added.size(), 0);
    for (const double free_cost : {0.5, 1.5, 4.0, 9.0, 20.0, 45.0, 100.0, 1e6}) {
      layout.rule.free_cost = free_cost;
      const Counts counts = countMatched(layout);
      for (std::size_t level = 0; level < counts.size(); ++level) {
        EXPECT_GE(counts[level], before[level]);
      }
      before = counts;
    }
    EXPECT_EQ(before, countMost(layout));
  }
}

TEST(PixelMatching, IsBrokenOffAtItsDeadline) {
  const PixelMatchingRule rule = pixelMatchingRule(kSize);
  const Deadline gone = Deadline::after(0);
  EXPECT_TRUE(gone.passed());
  EXPECT_FALSE(Deadline().passed());
  EXPECT_FALSE(Deadline::after(1e300).passed());
  const PixelLayout chain = test::shiftedChain(kSize, rule, 150);
  EXPECT_THROW(countMatchedPixels(kSize, rule, chain.ground_truth, chain.added, gone),
               DeadlineError);
  EXPECT_EQ(countMatchedPixels(kSize, rule, chain.ground_truth, chain.added, Deadline::after(3600)),
            (Counts{150, 150}));
}

TEST(PixelMatching, RefusesARuleThatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Pixels one = {{0, 0}};
  const auto count = [&one](ImageSize size, PixelMatchingRule rule) {
    return [=] { countMatchedPixels(size, rule, one, {one}); };
  };
  test::expectError(count({0, 4}, {1, 1}), {"0 x 4", "positive size"});
  test::expectError(count({4, 4}, {0, 1}), {"reach", "0", "expected 1 to 255"});
  test::expectError(count({4, 4}, {256, 1}), {"reach", "256"});
  for (const double free_cost : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    test::expectError(count({4, 4}, {1, free_cost}), {"cost of a free pixel", "positive"});
  }
}

}  // namespace
}  // namespace evolin
