// Average precision of resampled sequences against that of sequences which hold the copies.
#include "evolin_ros/metrics/resampled_precision.h"

#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>
#include <vector>

#include "evolin_ros/base/error.h"
#include "src/metrics/resampled_areas.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr std::uint32_t kFrames = 7;
constexpr std::size_t kSettings = 11;  // more than are worked on at a time

struct Sequence {
  std::vector<ScoreRanking::Entry> entries;
  std::vector<std::uint32_t> ground_truth;

  ScoreRanking ranking(Protocol protocol) const {
    return {protocol, kSettings, entries, ground_truth};
  }
};

Sequence randomSequence(int seed) {
  test::RandomLines random(seed);
  Sequence sequence;
  for (int i = 0; i < 500; ++i) {
    sequence.entries.push_back({static_cast<std::uint32_t>(random.uniform(0, kFrames)),
                                static_cast<std::uint32_t>(random.uniform(0, 1U << kSettings))});
  }
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    sequence.ground_truth.push_back(10 * frame);
  }
  return sequence;
}

/// Copies of a frame are frames of their own, copies of a prediction follow each other.
Sequence repeated(const Sequence& sequence, const std::vector<std::uint32_t>& weights) {
  Sequence all;
  for (const ScoreRanking::Entry& entry : sequence.entries) {
    all.entries.insert(all.entries.end(), weights[entry.frame], {0, entry.hits});
  }
  all.ground_truth.push_back(0);
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    all.ground_truth[0] += weights[frame] * sequence.ground_truth[frame];
  }
  return all;
}

TEST(ResampledPrecision, EqualsThatOfTheRepeatedSequence) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const Sequence sequence = randomSequence(1);
    ResampledPrecision resampled(sequence.ranking(protocol));
    // More and more predictions, and a first prediction that does not occur.
    for (const std::vector<std::uint32_t>& weights : std::vector<std::vector<std::uint32_t>>{
             {1, 1, 1, 1, 1, 1, 1}, {2, 0, 1, 3, 0, 0, 1}, {0, 0, 0, 0, 0, 0, 40}}) {
      const auto found = resampled.averagePrecisions(weights);
      const auto expected = repeated(sequence, weights).ranking(protocol).averagePrecisions();
      ASSERT_EQ(found.size(), kSettings);
      for (std::size_t setting = 0; setting < kSettings; ++setting) {
        EXPECT_NEAR(*found[setting], *expected[setting], 1e-12) << setting;
      }
    }
  }
}

TEST(ResampledPrecision, OfPerfectPredictions) {
  const std::vector<ScoreRanking::Entry> entries = {{0, 1}, {1, 1}};
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    ResampledPrecision resampled(ScoreRanking(protocol, 1, entries, {1, 1}));
    const bool anchored = protocol == Protocol::kPaper;
    EXPECT_DOUBLE_EQ(*resampled.averagePrecisions({0, 1})[0], anchored ? 1 : 0);
    EXPECT_DOUBLE_EQ(*resampled.averagePrecisions({1, 1})[0], anchored ? 1 : 0.5);
    EXPECT_DOUBLE_EQ(*resampled.averagePrecisions({2, 2})[0], anchored ? 1 : 0.75);
  }
}

TEST(ResampledPrecision, IsEmptyWithoutPredictionsOrTruth) {
  const std::vector<ScoreRanking::Entry> entries = {{0, 1}, {2, 1}};
  ResampledPrecision resampled(ScoreRanking(Protocol::kEvolin, 1, entries, {0, 5, 1}));
  EXPECT_FALSE(resampled.averagePrecisions({1, 0, 0})[0]) << "no truth";
  EXPECT_FALSE(resampled.averagePrecisions({0, 1, 0})[0]) << "no prediction";
  EXPECT_TRUE(resampled.averagePrecisions({1, 0, 1})[0]);
  EXPECT_FALSE(resampled.averagePrecisions({0, 0, 0})[0]);
  EXPECT_THROW(resampled.averagePrecisions({1, 2}), Error);
}

TEST(ResampledAreas, AreTheSameToTheLastBitOnEveryProcessor) {
  if (!cv::checkHardwareSupport(CV_CPU_AVX2)) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  const Sequence sequence = randomSequence(2);
  std::vector<FrameWeight> weights;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    weights.push_back({static_cast<double>(frame % 3), frame % 3});
  }
  std::vector<double> steps = {0, 0};
  while (steps.size() <= 2 * sequence.entries.size()) {
    const auto n = static_cast<double>(steps.size());
    steps.push_back(steps.back() + (1 / (n - 1) + 1 / n) / 2);
  }
  for (const unsigned shift : {0U, 8U}) {
    ResampledAreas of_generic;
    ResampledAreas of_wide;
    generic::resampleAreas(sequence.entries.data(), sequence.entries.size(), shift, weights.data(),
                           steps.data(), &of_generic);
    wide::resampleAreas(sequence.entries.data(), sequence.entries.size(), shift, weights.data(),
                        steps.data(), &of_wide);
    for (std::size_t lane = 0; lane < kAreaSettings; ++lane) {
      EXPECT_EQ(of_generic.losses[lane], of_wide.losses[lane]);
      EXPECT_EQ(of_generic.misses[lane], of_wide.misses[lane]);
    }
    EXPECT_GT(of_generic.losses[0], 1);
  }
}

}  // namespace
}  // namespace evolin
