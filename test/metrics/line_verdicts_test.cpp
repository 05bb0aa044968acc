// Verdicts on single lines: by hand, and against the counts of the metrics.
#include "evolin_ros/metrics/line_verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/evaluation/sample_frames.h"
#include "test/support/expect_error.h"

namespace evolin::test {
namespace {

constexpr ImageSize kSize{kSide, kSide};
using Verdicts = std::vector<LineVerdict>;
constexpr LineVerdict kHit = LineVerdict::kTruePositive;
constexpr LineVerdict kMiss = LineVerdict::kFalsePositive;

TEST(LineVerdicts, OfTheHandMadeFrame) {
  const LineSegments truth = handTruth(0).lines;
  const LineSegments lines = handLines(0).lines;
  LineVerdicts verdicts =
      judgeLines({LineDistance::kStructural, 5}, Protocol::kEvolin, kSize, lines, truth, true);
  EXPECT_EQ(verdicts.predicted, (Verdicts{kHit, kMiss, kMiss}));
  EXPECT_EQ(verdicts.found, (std::vector<bool>{true, false}));
  verdicts =
      judgeLines({LineDistance::kOrthogonal, 5}, Protocol::kEvolin, kSize, lines, truth, true);
  EXPECT_EQ(verdicts.predicted, (Verdicts{kHit, kHit, kMiss}));
  EXPECT_EQ(verdicts.found, (std::vector<bool>{true, true}));
}

TEST(LineVerdicts, NameWhatTheProtocolDrops) {
  const LineSegments lines = {line(10, 20, 60, 20), line(5, 5, 5, 5)};
  const LineSegments truth = {line(10, 20, 60, 20)};
  EXPECT_EQ(
      judgeLines({LineDistance::kStructural, 5}, Protocol::kEvolin, kSize, lines, truth, false)
          .predicted,
      (Verdicts{LineVerdict::kDropped, LineVerdict::kDropped}));
  EXPECT_EQ(judgeLines({LineDistance::kStructural, 5}, Protocol::kPaper, kSize, lines, truth, false)
                .predicted,
            (Verdicts{kHit, LineVerdict::kDropped}));
}

TEST(LineVerdicts, AddUpToTheMetrics) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    VectorizedOptions options;
    options.protocol = protocol;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      RandomLines random(seed);
      const ImageSize size{320, 240};
      const LineSegments truth = random.anywhere(random.index(25), 319, 239);
      LineSegments lines =
          truth.empty() ? random.anywhere(3, 319, 239) : random.detectionsOf(truth, 40, 12);
      const bool scored = seed % 2 == 0;
      for (LineSegment& found : lines) {
        found.score = scored ? (found.hasScore() ? found.score : 0.5) : kNoScore;
        found.y2 = random.index(8) == 0 ? found.y1 : found.y2;  // some exactly horizontal
      }
      VectorizedMetrics metrics(options);
      metrics.addFrame(0, "0", size, lines, truth, scored);
      for (std::size_t i = 0; i < metrics.settings().size(); ++i) {
        const LineVerdicts verdicts =
            judgeLines(metrics.settings()[i], protocol, size, lines, truth, scored);
        const Classification counts = metrics.classification(i);
        const auto number = [&](LineVerdict verdict) {
          return std::count(verdicts.predicted.begin(), verdicts.predicted.end(), verdict);
        };
        EXPECT_EQ(number(kHit), static_cast<std::ptrdiff_t>(counts.true_positives)) << seed;
        EXPECT_EQ(number(kHit) + number(kMiss), static_cast<std::ptrdiff_t>(counts.predicted))
            << seed;
        EXPECT_EQ(std::count(verdicts.found.begin(), verdicts.found.end(), true), number(kHit));
        EXPECT_EQ(verdicts.found.size(), truth.size());
      }
    }
  }
}

TEST(LineVerdicts, RefuseWhatTheMetricsRefuse) {
  const VectorizedSetting setting{LineDistance::kStructural, 5};
  const auto judge = [&](const LineSegments& lines, const LineSegments& truth, ImageSize size) {
    judgeLines(setting, Protocol::kEvolin, size, lines, truth, false);
  };
  expectError([&] { judge({line(NAN, 0, 1, 1)}, {}, kSize); }, {"predicted line 0", "not finite"});
  expectError([&] { judge({}, {line(1, 1, 1, 1)}, kSize); }, {"ground-truth line 0", "no length"});
  expectError([&] { judge({}, {}, {0, 5}); }, {"0 x 5"});
}

}  // namespace
}  // namespace evolin::test
