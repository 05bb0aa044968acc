// A change of settings within a stream: which pass every part goes to, and that no figure is of
// two settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/stream_evaluator.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::detected;
using test::expectEqual;
using test::expectSeenIsTheSum;
using test::give;
using test::handLines;
using test::handTruth;
using test::kSecond;
using test::matchSet;
using test::Part;
using test::randomPass;

constexpr std::size_t kFrames = 24;
constexpr Stamp kBoundary = 11 * kSecond;  ///< frame 10, which has lines and annotation

/// What a method's settings decide on, and coverage.
void expectSameFigures(const Report& report, const Report& expected) {
  expectEqual(report.coverage, expected.coverage);
  ASSERT_EQ(report.detection.size(), expected.detection.size());
  for (std::size_t i = 0; i < report.detection.size(); ++i) {
    EXPECT_EQ(report.detection[i].counts.true_positives,
              expected.detection[i].counts.true_positives);
    EXPECT_EQ(report.detection[i].counts.predicted, expected.detection[i].counts.predicted);
    EXPECT_EQ(report.detection[i].counts.ground_truth, expected.detection[i].counts.ground_truth);
    EXPECT_EQ(report.detection[i].average_precision, expected.detection[i].average_precision);
  }
  EXPECT_EQ(framesToCsv(report), framesToCsv(expected));
  EXPECT_EQ(report.lines_source, expected.lines_source);
}

Report reportOf(const std::vector<Part>& parts) {
  PassEvaluation pass;
  for (const Part& part : parts) give(part, &pass);
  return pass.report(true);
}

/// Parts of the frames from one stamp up to, but without, another; pairs that lie within.
std::vector<Part> between(const std::vector<Part>& parts, Stamp from, Stamp to) {
  std::vector<Part> chosen;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(chosen), [&](const Part& part) {
    const Stamp first = part.kind == Part::kMatches ? part.matches.first_stamp : part.stamp;
    return first >= from && part.stamp < to;
  });
  return chosen;
}

/// Lines come so many frames after what else there is of theirs.
std::vector<Part> withLinesLate(std::vector<Part> parts, int frames) {
  std::stable_sort(parts.begin(), parts.end(), [&](const Part& a, const Part& b) {
    const auto due = [&](const Part& part) {
      return part.stamp + (part.kind == Part::kLines ? frames * kSecond : 0);
    };
    return due(a) < due(b);
  });
  return parts;
}

TEST(StreamSettings, OtherLinesBeginAPassWithTheirFirstFrame) {
  for (const int late : {0, 1, 3, static_cast<int>(kFrames)}) {
    SCOPED_TRACE("lines come " + std::to_string(late) + " frames late");
    std::vector<Part> parts = randomPass(5, kFrames);
    for (Part& part : parts) {
      if (part.kind == Part::kLines && part.stamp >= kBoundary) {
        part.lines.source = "detector#1";
      }
    }
    StreamEvaluator stream;
    std::string told;
    for (const Part& part : withLinesLate(parts, late)) {
      told += give(part, &stream).changed_settings;
    }
    EXPECT_EQ(told,
              "the lines are those of 'detector#1' from 11.000000 s on, no longer those of "
              "'detector'");
    ASSERT_EQ(stream.pass(), 2);
    const Report expected_first = reportOf(between(parts, 0, kBoundary));
    const Report expected_second = reportOf(between(parts, kBoundary, 1000 * kSecond));
    const std::optional<Report> first = stream.previousReport();
    const Report second = stream.report(true);
    ASSERT_TRUE(first.has_value());
    {
      SCOPED_TRACE("first pass");
      expectSameFigures(*first, expected_first);
    }
    {
      SCOPED_TRACE("second pass");
      expectSameFigures(second, expected_second);
      EXPECT_EQ(second.association.true_positives, expected_second.association.true_positives);
      EXPECT_EQ(second.association.predicted, expected_second.association.predicted);
      EXPECT_EQ(pairsToCsv(second), pairsToCsv(expected_second));
    }
    for (const Report& report : {*first, second}) {
      EXPECT_EQ(std::count(report.notes.begin(), report.notes.end(), told), 1);
    }
  }
}

TEST(StreamSettings, OtherMatchesBeginAPassBehindTheLinesThatAreScored) {
  std::vector<Part> parts = randomPass(7, kFrames);
  for (Part& part : parts) {
    if (part.kind == Part::kMatches && part.stamp >= kBoundary) {
      part.matches.source = "associator#1";
    }
  }
  StreamEvaluator stream;
  for (const Part& part : parts) give(part, &stream);
  ASSERT_EQ(stream.pass(), 2);
  const Stamp second_begins = kBoundary + kSecond;
  expectSameFigures(*stream.previousReport(), reportOf(between(parts, 0, second_begins)));
  const Report expected = reportOf(between(parts, second_begins, 1000 * kSecond));
  const Report report = stream.report(true);
  expectSameFigures(report, expected);
  EXPECT_EQ(pairsToCsv(report), pairsToCsv(expected));
  // The pair that told of the change and the one across it.
  EXPECT_EQ(report.pairs.skipped, expected.pairs.skipped + 2);
  EXPECT_EQ(report.matches_source, "associator#1");
}

TEST(StreamSettings, ThereAndBackAreThreePasses) {
  StreamEvaluator stream;
  for (int i = 1; i <= 30; ++i) {
    LineSet lines = handLines(i * kSecond);
    lines.source = i > 10 && i <= 20 ? "detector#1" : "detector";
    give({Part::kGroundTruth, lines.stamp, handTruth(lines.stamp), {}}, &stream);
    give({Part::kLines, lines.stamp, lines, {}}, &stream);
  }
  EXPECT_EQ(stream.pass(), 3);
  EXPECT_EQ(stream.coverage().evaluated, 10U);
  EXPECT_EQ(stream.coverage().seen, 10U);
  EXPECT_EQ(stream.takeReleasedReport()->coverage.evaluated, 10U);
}

TEST(StreamSettings, ALoopAfterAChangeIsOnePassMore) {
  const std::vector<Part> parts = randomPass(9, kFrames);
  StreamEvaluator stream;
  for (Part part : parts) {
    part.lines.source += part.kind == Part::kLines && part.stamp >= kBoundary ? "#1" : "";
    give(part, &stream);
  }
  std::vector<Part> again = parts;
  for (Part& part : again) {
    part.lines.source += part.kind == Part::kLines ? "#1" : "";
    give(part, &stream);
  }
  EXPECT_EQ(stream.pass(), 3);
  expectSameFigures(stream.report(true), reportOf(again));
}

TEST(StreamSettings, TwoSourcesOfOneStampShareTheTopic) {
  StreamEvaluator stream;
  for (int i = 1; i <= 6; ++i) {
    for (int k = 0; k < 2; ++k) {
      LineSet lines = handLines(i * kSecond);
      lines.source = (k + i) % 2 == 0 ? "left" : "right";
      give({Part::kLines, lines.stamp, lines, {}}, &stream);
    }
  }
  EXPECT_EQ(stream.pass(), 1);
  EXPECT_EQ(stream.coverage().dropped, 6U);
}

TEST(StreamSettings, ALateResultOfTheSettingsBeforeIsDropped) {
  StreamEvaluator stream;
  for (int i = 1; i <= 5; ++i) {
    give({Part::kGroundTruth, i * kSecond, handTruth(i * kSecond), {}}, &stream);
  }
  for (const auto& [second, source] :
       std::vector<std::pair<int, std::string>>{{1, "a"}, {2, "a"}, {4, "b"}, {3, "a"}, {5, "b"}}) {
    LineSet lines = handLines(second * kSecond);
    lines.source = source;
    give({Part::kLines, lines.stamp, lines, {}}, &stream);
  }
  EXPECT_EQ(stream.pass(), 2);
  EXPECT_EQ(stream.report(true).lines_source, "b");
  EXPECT_EQ(stream.coverage().evaluated, 2U);
  EXPECT_EQ(stream.coverage().dropped, 1U);
}

TEST(StreamSettings, DepthAndPosesThatRanAheadGoAlong) {
  StreamEvaluator stream;
  Camera camera;
  camera.width = camera.height = test::kSide;
  camera.fx = camera.fy = 100;
  camera.cx = camera.cy = 64;
  stream.setCamera(camera);
  const DepthMap depth(cv::Mat(test::kSide, test::kSide, CV_32FC1, cv::Scalar(2)));
  for (int i = 1; i <= 20; ++i) {
    stream.addDepth(i * kSecond, depth);
    stream.addPose({i * kSecond, Pose()});
    give({Part::kGroundTruth, i * kSecond, handTruth(i * kSecond), {}}, &stream);
  }
  for (int i = 1; i <= 20; ++i) {
    LineSet lines = handLines(i * kSecond);
    lines.source = i > 8 ? "b" : "a";
    give({Part::kLines, lines.stamp, lines, {}}, &stream);
  }
  ASSERT_EQ(stream.pass(), 2);
  const CoverageCounts counts = stream.report(true).coverage;
  EXPECT_EQ(counts.evaluated, 12U);
  EXPECT_EQ(counts.no_depth, 0U);
  EXPECT_EQ(counts.no_pose, 0U);
  EXPECT_EQ(stream.current().motion().counts().frames, 12U);
}

TEST(StreamSettings, WhatComesWhilePausedIsCountedAsSkipped) {
  StreamEvaluator stream;
  for (int i = 1; i <= 9; ++i) {
    const Stamp stamp = i * kSecond;
    // The ground truth of frame 4 comes before the pause and its lines within, that of frame 7
    // within and its lines behind.
    give({Part::kGroundTruth, stamp, handTruth(stamp), {}}, &stream);
    stream.pause(i >= 4 && i <= 6);
    give({Part::kImage, stamp, {}, {}}, &stream);
    give({Part::kLines, stamp, handLines(stamp), {}}, &stream);
    if (i > 1) {
      give({Part::kMatches, stamp, {}, matchSet(stamp - kSecond, stamp, "ground_truth", {{0, 0}})},
           &stream);
    }
  }
  const Report report = stream.report(true);
  EXPECT_EQ(report.coverage.seen, 9U);
  EXPECT_EQ(report.coverage.evaluated, 5U);
  EXPECT_EQ(report.coverage.skipped, 4U);
  expectSeenIsTheSum(report.coverage);
  EXPECT_EQ(report.pairs.skipped, 3U);
  EXPECT_EQ(std::count_if(report.notes.begin(), report.notes.end(),
                          [](const std::string& note) {
                            return note.find("while the evaluation was paused") !=
                                   std::string::npos;
                          }),
            3);
  stream.pause(true);
  stream.reset();
  EXPECT_TRUE(stream.isPaused());
}

}  // namespace
}  // namespace evolin
