// Matches and tracks of a pass: ids or matches followed beyond the buffer, and what has left it.
#include <gtest/gtest.h>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::handLines;
using test::handTruth;
using test::kSecond;
using test::matchSet;
using test::withBuffer;

TEST(PassTracks, TracksNeedNoGroundTruth) {
  PassEvaluation pass;
  for (const Stamp stamp : {1, 2, 3}) {
    LineSet lines = handLines(stamp);
    for (LineSegment& line : lines.lines) line.id = kNoId;
    pass.addLines(lines);
    if (stamp > 1) pass.addMatches(matchSet(stamp - 1, stamp, "detector", {{0, 0}, {1, 1}}));
  }
  const Report report = pass.report(true);
  EXPECT_TRUE(report.tracks.from_matches);
  // Two lines followed through three frames, the third one new in each.
  EXPECT_EQ(report.tracks.tracks, 5U) << report.tracks.reason;
  EXPECT_EQ(report.tracks.longest, 3U);
  EXPECT_EQ(report.detected_pairs.no_ground_truth, 2U);
}

/// Line 0 is the same physical line throughout but changes its id every 40 frames.
void addTracked(Stamp first, Stamp last, PassEvaluation* pass) {
  for (Stamp stamp = first; stamp <= last; ++stamp) {
    LineSet lines = handLines(stamp);
    lines.lines[0].id = stamp / 40;
    lines.lines[1].id = 1000;
    lines.lines[2].id = kNoId;
    pass->addGroundTruth(handTruth(stamp));
    pass->addLines(lines);
  }
}

TEST(PassTracks, TracksOfALongPassOutliveTheBuffer) {
  for (const std::size_t buffer : {std::size_t{2}, std::size_t{50}, std::size_t{1000}}) {
    PassEvaluation pass(withBuffer(buffer));
    addTracked(1, 199, &pass);
    const TrackReport tracks = pass.report(true).tracks;
    EXPECT_FALSE(tracks.from_matches) << "buffer " << buffer;
    EXPECT_EQ(tracks.frames, 199U) << "buffer " << buffer;
    EXPECT_EQ(tracks.tracks, 6U) << "buffer " << buffer;
    EXPECT_EQ(tracks.longest, 199U) << "buffer " << buffer;
    // The second line is beyond the gate of every annotated one.
    EXPECT_EQ(tracks.observations, 199U) << "buffer " << buffer;
    EXPECT_EQ(tracks.identity_switches, 4U) << "buffer " << buffer;
  }
}

TEST(PassTracks, TracksCountAFrameThatComesAfterManyLaterOnes) {
  PassEvaluation pass;
  addTracked(2, 100, &pass);
  addTracked(1, 1, &pass);
  const TrackReport tracks = pass.report(true).tracks;
  EXPECT_EQ(tracks.frames, 99U);
  EXPECT_EQ(tracks.late, 1U);
}

TEST(PassTracks, MatchesOfFramesThatLeftTheBufferAreSkipped) {
  PassEvaluation pass(withBuffer(2));
  addTracked(1, 100, &pass);
  pass.addMatches(matchSet(1, 2, "detector", {{0, 0}}));
  const Report report = pass.report(true);
  EXPECT_EQ(report.detected_pairs.skipped, 1U);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes.back().find("raise buffer"), std::string::npos) << report.notes.back();
}

/// By matches where `ids` is false: a frame has the lines 0, 1, 2 and every tenth loses the second.
TrackReport tracksOf(int frames, std::size_t buffer, bool ids) {
  PassOptions options = withBuffer(buffer);
  options.families = {MetricFamily::kTracks};
  PassEvaluation pass(options);
  for (int i = 0; i < frames; ++i) {
    const Stamp stamp = (i + 1) * kSecond;
    LineSet lines = handLines(stamp);
    for (std::size_t row = 0; ids && row < 3; ++row) {
      lines.lines[row].id = static_cast<std::int64_t>(row) + (row == 1 ? 10 * (i / 10) : 0);
    }
    pass.addGroundTruth(handTruth(stamp));
    pass.addLines(lines);
    LineMatches matches = {{0, 0}, {2, 2}};
    if (i % 10 != 0) matches.push_back({1, 1});
    if (i > 0) pass.addMatches(matchSet(stamp - kSecond, stamp, "detector", matches));
  }
  return pass.tracks();
}

TEST(PassTracks, TracksAreTheSameWhateverTheBuffer) {
  for (const bool ids : {true, false}) {
    SCOPED_TRACE(ids);
    for (const std::size_t buffer : {std::size_t{2}, std::size_t{40}, std::size_t{1000}}) {
      const TrackReport tracks = tracksOf(200, buffer, ids);
      EXPECT_EQ(tracks.from_matches, !ids);
      EXPECT_EQ(tracks.frames, 200U);
      EXPECT_EQ(tracks.tracks, 22U);
      EXPECT_EQ(tracks.longest, 200U);
      EXPECT_EQ(tracks.median_length, 10);
      EXPECT_EQ(tracks.identity_switches, 0U) << "the second line is 6 pixels off: beyond the gate";
      EXPECT_EQ(tracks.late, 0U);
    }
  }
}

TEST(PassTracks, MatchesOfFramesThatHaveLeftTheBufferAreSkippedWithANote) {
  PassOptions options = withBuffer(3);
  options.families = {MetricFamily::kAssociation};
  PassEvaluation pass(options);
  for (int i = 1; i <= 10; ++i) {
    pass.addGroundTruth(handTruth(i * kSecond));
    pass.addLines(handLines(i * kSecond));
  }
  pass.addMatches(matchSet(kSecond, 2 * kSecond, "detector", {{0, 0}}));
  pass.addMatches(matchSet(9 * kSecond, 10 * kSecond, "detector", {{0, 0}}));
  const Report report = pass.report(true);
  EXPECT_EQ(report.detected_pairs.evaluated, 1U);
  EXPECT_EQ(report.detected_pairs.skipped, 1U);
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_NE(report.notes[0].find("left the buffer of 3"), std::string::npos) << report.notes[0];
}

}  // namespace
}  // namespace evolin
