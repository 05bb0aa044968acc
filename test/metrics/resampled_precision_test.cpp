// Average precision of resampled sequences against that of sequences which hold the copies.
#include "evolin_ros/metrics/resampled_precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <utility>
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

std::vector<std::optional<double>> precisionsOf(ResampledPrecision* resampled,
                                                const std::vector<std::uint32_t>& weights) {
  return resampled->averagePrecisions({weights}).at(0);
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
    // More and more predictions, a first prediction that does not occur, and more resamples than
    // are worked on at a time.
    std::vector<std::vector<std::uint32_t>> resamples = {
        {1, 1, 1, 1, 1, 1, 1}, {2, 0, 1, 3, 0, 0, 1}, {0, 0, 0, 0, 0, 0, 40}};
    test::RandomLines random(3);
    while (resamples.size() < kAreaLanes + 10) {
      resamples.emplace_back();
      for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
        resamples.back().push_back(static_cast<std::uint32_t>(random.uniform(0, 4)));
      }
    }
    const auto found = resampled.averagePrecisions(resamples);
    ASSERT_EQ(found.size(), resamples.size());
    for (std::size_t i = 0; i < resamples.size(); ++i) {
      const auto expected = repeated(sequence, resamples[i]).ranking(protocol).averagePrecisions();
      ASSERT_EQ(found[i].size(), kSettings);
      for (std::size_t setting = 0; setting < kSettings; ++setting) {
        EXPECT_NEAR(*found[i][setting], *expected[setting], 1e-12) << i << ", " << setting;
      }
    }
  }
}

TEST(ResampledPrecision, OfPerfectPredictions) {
  const std::vector<ScoreRanking::Entry> entries = {{0, 1}, {1, 1}};
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    ResampledPrecision resampled(ScoreRanking(protocol, 1, entries, {1, 1}));
    const bool anchored = protocol == Protocol::kPaper;
    EXPECT_DOUBLE_EQ(*precisionsOf(&resampled, {0, 1})[0], anchored ? 1 : 0);
    EXPECT_DOUBLE_EQ(*precisionsOf(&resampled, {1, 1})[0], anchored ? 1 : 0.5);
    EXPECT_DOUBLE_EQ(*precisionsOf(&resampled, {2, 2})[0], anchored ? 1 : 0.75);
  }
}

TEST(ResampledPrecision, IsEmptyWithoutPredictionsOrTruth) {
  const std::vector<ScoreRanking::Entry> entries = {{0, 1}, {2, 1}};
  ResampledPrecision resampled(ScoreRanking(Protocol::kEvolin, 1, entries, {0, 5, 1}));
  EXPECT_FALSE(precisionsOf(&resampled, {1, 0, 0})[0]) << "no truth";
  EXPECT_FALSE(precisionsOf(&resampled, {0, 1, 0})[0]) << "no prediction";
  EXPECT_TRUE(precisionsOf(&resampled, {1, 0, 1})[0]);
  EXPECT_FALSE(precisionsOf(&resampled, {0, 0, 0})[0]);
  EXPECT_THROW(precisionsOf(&resampled, {1, 2}), Error);
  EXPECT_THROW(precisionsOf(&resampled, {1U << 31U, 1, 1}), Error) << "2^31 predictions";
}

TEST(ResampledAreas, AreTheSameToTheLastBitOnEveryProcessor) {
  if (!cv::checkHardwareSupport(CV_CPU_AVX2)) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  const Sequence sequence = randomSequence(2);
  std::vector<std::uint32_t> frames;
  std::vector<RankedRun> runs;
  for (const ScoreRanking::Entry& entry : sequence.entries) {
    frames.push_back(entry.frame);
    if (frames.size() % 3 == 0) {
      runs.push_back({entry.hits, static_cast<std::uint32_t>(frames.size())});
    }
  }
  std::vector<std::int32_t> weights;
  for (std::size_t i = 0; i < kFrames * kAreaLanes; ++i) {
    weights.push_back(static_cast<std::int32_t>(i * i % 11 % 4));
  }
  std::vector<double> steps = {0, 0};
  while (steps.size() <= 3 * sequence.entries.size()) {
    const auto n = static_cast<double>(steps.size());
    steps.push_back(steps.back() + (1 / (n - 1) + 1 / n) / 2);
  }
  const RankedRuns ranked{frames.data(), runs.data(), runs.size(), kSettings};
  using Sums = std::pair<std::vector<double>, std::vector<double>>;
  const auto sumsBy = [&](const decltype(&generic::resampleAreas) resample) {
    Sums sums;
    sums.first.assign(kSettings * kAreaLanes, -1);
    sums.second.assign(kSettings * kAreaLanes, -1);
    resample(ranked, weights.data(), steps.data(), sums.first.data(), sums.second.data());
    return sums;
  };
  const Sums expected = sumsBy(generic::resampleAreas);
  EXPECT_GT(*std::min_element(expected.first.begin(), expected.first.end()), 1);
  EXPECT_EQ(sumsBy(wide::resampleAreas), expected);
  if (cv::checkHardwareSupport(CV_CPU_AVX512_SKX)) {
    EXPECT_EQ(sumsBy(widest::resampleAreas), expected);
  }
}

}  // namespace
}  // namespace evolin
