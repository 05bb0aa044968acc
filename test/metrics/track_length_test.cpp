// Tracks from matches, their lengths, and changes of identity.
#include "evolin_ros/metrics/track_length.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using Ids = std::vector<std::int64_t>;
using test::expectError;

TEST(TrackBuilder, LinesInheritTheirMatchsId) {
  TrackBuilder builder;
  EXPECT_EQ(builder.addFrame(3, {}), (Ids{0, 1, 2}));
  EXPECT_EQ(builder.addFrame(2, {{2, 0}}), (Ids{2, 3}));
  EXPECT_EQ(builder.addFrame(3, {{0, 2}, {1, 1}}), (Ids{4, 3, 2}));
  EXPECT_EQ(builder.addFrame(0, {}), Ids{});
  EXPECT_EQ(builder.addFrame(1, {}), Ids{5});
}

TEST(TrackBuilder, ARowIsContinuedOnce) {
  TrackBuilder builder;
  builder.addFrame(2, {});
  // Row 0 goes to row 0; then neither (0, 1) nor (1, 0) has both ends free.
  EXPECT_EQ(builder.addFrame(2, {{1, 0}, {0, 1}, {0, 0}, {0, 0}}), (Ids{0, 2}));
}

TEST(TrackBuilder, SequencesAreApart) {
  TrackBuilder builder;
  builder.addFrame(2, {});
  builder.startSequence();
  EXPECT_EQ(builder.addFrame(1, {}), Ids{2});
  expectError([&] { builder.addFrame(1, {{1, 0}}); }, {"(1, 0)", "1 lines in the frame before"});
  expectError([&] { builder.addFrame(1, {{0, 1}}); }, {"(0, 1)", "1 in this one"});
  expectError([&] { builder.addFrame(1, {{-1, 0}}); }, {"(-1, 0)"});
}

TEST(TrackMetrics, LengthsAreNumbersOfFrames) {
  TrackMetrics metrics;
  EXPECT_FALSE(metrics.meanLength().has_value());
  EXPECT_FALSE(metrics.medianLength().has_value());
  EXPECT_EQ(metrics.longest(), 0U);
  metrics.addFrame({10, 11});
  metrics.addFrame({12, 11});
  metrics.addFrame({kNoId, 11, 10, kNoId});  // 10 comes back; untracked lines are no tracks
  metrics.addFrame({11});
  EXPECT_EQ(metrics.frames(), 4U);
  EXPECT_EQ(metrics.tracks(), 3U);
  EXPECT_DOUBLE_EQ(*metrics.meanLength(), 7.0 / 3);  // 2, 4, 1
  EXPECT_EQ(metrics.medianLength(), 2);
  EXPECT_EQ(metrics.longest(), 4U);
  metrics.addFrame({13});
  EXPECT_EQ(metrics.medianLength(), 1.5);  // 1, 1, 2, 4
  EXPECT_EQ(metrics.identitySwitches(), 0U);
  EXPECT_EQ(metrics.observations(), 0U);
}

TEST(TrackMetrics, FinishedSequencesKeepTheirTracks) {
  TrackMetrics metrics;
  metrics.addFrame({1, 2}, {7, 8});
  metrics.finishSequence();
  metrics.addFrame({1}, {9});
  EXPECT_EQ(metrics.tracks(), 3U);
  EXPECT_EQ(metrics.longest(), 1U);
  EXPECT_EQ(metrics.drifts(), 0U);
  EXPECT_EQ(metrics.identitySwitches(), 0U);
}

TEST(TrackMetrics, ALineShownByAnotherTrackIsASwitch) {
  TrackMetrics metrics;
  metrics.addFrame({1, 2}, {7, 8});
  metrics.addFrame({3, 2}, {7, 8});  // 7: from track 1 to 3
  metrics.addFrame({2}, {8});        // 7 is not seen
  metrics.addFrame({1, 2}, {7, 8});  // 7: from 3 back to 1
  EXPECT_EQ(metrics.identitySwitches(), 2U);
  EXPECT_EQ(metrics.drifts(), 0U);
  EXPECT_EQ(metrics.observations(), 7U);
}

TEST(TrackMetrics, ATrackThatShowsAnotherLineDrifts) {
  TrackMetrics metrics;
  metrics.addFrame({1}, {7});
  metrics.addFrame({1}, {kNoId});
  metrics.addFrame({1}, {8});
  metrics.addFrame({1}, {8});
  EXPECT_EQ(metrics.drifts(), 1U);
  EXPECT_EQ(metrics.identitySwitches(), 0U);
}

TEST(TrackMetrics, PiecesOfALineAreNoSwitchWhileTheLastTrackShowsIt) {
  TrackMetrics metrics;
  metrics.addFrame({1, 2}, {7, 7});  // track 1 has the lower row
  metrics.addFrame({2, 1}, {7, 7});
  EXPECT_EQ(metrics.identitySwitches(), 0U);
  metrics.addFrame({2}, {7});
  EXPECT_EQ(metrics.identitySwitches(), 1U);
  metrics.addFrame({2, 1}, {7, 7});
  EXPECT_EQ(metrics.identitySwitches(), 1U);
  EXPECT_EQ(metrics.observations(), 4U);
}

TEST(TrackMetrics, ExchangedTracksAreTwoSwitchesAndTwoDrifts) {
  TrackMetrics metrics;
  metrics.addFrame({1, 2}, {7, 8});
  metrics.addFrame({1, 2}, {8, 7});
  EXPECT_EQ(metrics.identitySwitches(), 2U);
  EXPECT_EQ(metrics.drifts(), 2U);
}

TEST(TrackMetrics, RefusesFramesThatMakeNoSense) {
  TrackMetrics metrics;
  expectError([&] { metrics.addFrame({4, 5, 4}); }, {"id 4", "twice"});
  expectError([&] { metrics.addFrame({4, 5}, {1}); }, {"2 lines", "1 true ids"});
  EXPECT_EQ(metrics.frames(), 0U);
  EXPECT_EQ(metrics.tracks(), 0U);
}

TEST(TrackMetrics, MergeAddsSequences) {
  const auto first = [](TrackMetrics* metrics) {
    metrics->addFrame({1, 2}, {7, 8});
    metrics->addFrame({1, 3}, {7, 8});
  };
  const auto second = [](TrackMetrics* metrics) {
    metrics->addFrame({1}, {8});
    metrics->addFrame({1}, {7});
    metrics->addFrame({1}, {7});
  };
  TrackMetrics all;
  first(&all);
  all.finishSequence();
  second(&all);
  TrackMetrics a;
  first(&a);
  TrackMetrics b;
  second(&b);
  a.merge(b);
  for (const TrackMetrics* metrics : {&all, &a}) {
    EXPECT_EQ(metrics->frames(), 5U);
    EXPECT_EQ(metrics->tracks(), 4U);
    EXPECT_EQ(metrics->meanLength(), 7.0 / 4);
    EXPECT_EQ(metrics->medianLength(), 1.5);
    EXPECT_EQ(metrics->longest(), 3U);
    EXPECT_EQ(metrics->identitySwitches(), 1U);
    EXPECT_EQ(metrics->drifts(), 1U);
    EXPECT_EQ(metrics->observations(), 7U);
  }
  a.merge(a);
  EXPECT_EQ(a.tracks(), 8U);
  EXPECT_EQ(a.frames(), 10U);
  a.reset();
  EXPECT_EQ(a.tracks(), 0U);
  EXPECT_EQ(a.observations(), 0U);
}

}  // namespace
}  // namespace evolin
