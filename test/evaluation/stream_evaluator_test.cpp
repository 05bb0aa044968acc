// Telling passes apart: loops, stragglers, duplicates and late starts. Disorder is
// stream_order_test.cpp's.
#include "evolin_ros/evaluation/stream_evaluator.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::detected;
using test::expectEqual;
using test::expectSeenIsTheSum;
using test::handLines;
using test::handTruth;
using test::kSecond;
using test::Part;
using test::randomPass;
using test::textOf;

PassEvaluation passOf(const std::vector<Part>& parts) {
  PassEvaluation pass;
  for (const Part& part : parts) give(part, &pass);
  return pass;
}

/// What one pass over `parts` gives.
std::string reportOfOnePass(const std::vector<Part>& parts) {
  return textOf(passOf(parts).report(true));
}

TEST(StreamEvaluator, ALoopGivesTheFiguresOfOnePassInEach) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<Part> parts = randomPass(seed, 10);
    const std::string expected = reportOfOnePass(parts);
    StreamEvaluator stream;
    EXPECT_FALSE(stream.previousReport().has_value());
    for (int pass = 1; pass <= 4; ++pass) {
      bool begun = false;
      for (const Part& part : parts) {
        begun = give(part, &stream).new_pass || begun;
        expectEqual(stream.coverage(), stream.report(false).coverage);
      }
      EXPECT_EQ(begun, pass > 1);
      EXPECT_EQ(stream.pass(), pass);
      EXPECT_EQ(stream.report(true).pass, pass);
      EXPECT_EQ(textOf(stream.report(true)), expected);
      if (pass > 1) {
        EXPECT_EQ(stream.previousReport()->pass, pass - 1);
        EXPECT_TRUE(stream.previousReport()->complete);
        EXPECT_EQ(textOf(*stream.previousReport()), expected);
      }
    }
  }
}

TEST(StreamEvaluator, StragglersCountInTheirOwnPass) {
  // Lines lag two frames behind, matches three: a loop begins for images and ground truth while
  // the others still send the pass before.
  const std::vector<Part> parts = randomPass(3, 10);
  const std::string expected = reportOfOnePass(parts);
  StreamEvaluator stream;
  std::deque<Part> lines;
  std::deque<Part> matches;
  const auto release = [&stream](std::deque<Part>* queue, std::size_t lag) {
    while (queue->size() > lag) {
      give(queue->front(), &stream);
      queue->pop_front();
    }
  };
  for (int pass = 1; pass <= 5; ++pass) {
    for (const Part& part : parts) {
      if (part.kind == Part::kLines) {
        lines.push_back(part);
      } else if (part.kind == Part::kMatches) {
        matches.push_back(part);
      } else {
        give(part, &stream);
      }
      release(&lines, 2);
      release(&matches, 3);
    }
    if (pass > 1) {
      EXPECT_EQ(textOf(*stream.previousReport()), expected) << "pass " << pass - 1;
    }
  }
  release(&lines, 0);
  release(&matches, 0);
  EXPECT_EQ(stream.pass(), 5);
  EXPECT_EQ(textOf(stream.report(true)), expected);
}

TEST(StreamEvaluator, APassThatLeavesMemoryIsGivenOutOnce) {
  const std::vector<Part> parts = randomPass(5, 10);
  const std::string expected = reportOfOnePass(parts);
  StreamEvaluator stream;
  for (int pass = 1; pass <= 2; ++pass) {
    for (const Part& part : parts) give(part, &stream);
    EXPECT_FALSE(stream.takeReleasedReport().has_value());
  }
  EXPECT_TRUE(give(parts.front(), &stream).new_pass);
  const std::optional<Report> released = stream.takeReleasedReport();
  ASSERT_TRUE(released.has_value());
  EXPECT_EQ(released->pass, 1);
  EXPECT_TRUE(released->complete);
  EXPECT_EQ(textOf(*released), expected);
  EXPECT_FALSE(stream.takeReleasedReport().has_value());
}

TEST(StreamEvaluator, TellsOnceWhenThePassBeforeChanges) {
  StreamEvaluator stream;
  for (const Stamp stamp : {1, 2, 3}) stream.addLines(handLines(stamp * kSecond));
  for (const Stamp stamp : {1, 2}) stream.addGroundTruth(handTruth(stamp * kSecond));
  EXPECT_FALSE(stream.takePreviousChanged());
  EXPECT_EQ(stream.previous(), nullptr);
  stream.addLines(handLines(1 * kSecond));
  ASSERT_NE(stream.previous(), nullptr);
  EXPECT_TRUE(stream.takePreviousChanged());
  EXPECT_FALSE(stream.takePreviousChanged());
  stream.addLines(handLines(2 * kSecond));
  EXPECT_FALSE(stream.takePreviousChanged());
  // Another input is still in the pass before.
  stream.addGroundTruth(handTruth(3 * kSecond));
  EXPECT_TRUE(stream.takePreviousChanged());
}

TEST(StreamEvaluator, ADuplicateChangesNoFigureAndIsCounted) {
  const std::vector<Part> parts = randomPass(5, 10);
  StreamEvaluator stream;
  std::size_t frames = 0;
  std::size_t pairs = 0;
  std::map<Part::Kind, std::size_t> warnings;
  for (const Part& part : parts) {
    give(part, &stream);
    const EvaluationUpdate update = give(part, &stream);
    EXPECT_TRUE(update.frames.empty() && update.pairs.empty() && update.notes.empty());
    EXPECT_FALSE(update.new_pass);
    warnings[part.kind] += update.warnings.size();
    frames += part.kind == Part::kLines || part.kind == Part::kGroundTruth ? 1 : 0;
    pairs += part.kind == Part::kMatches ? 1 : 0;
  }
  EXPECT_EQ(stream.pass(), 1);
  // Once for each input; an image that comes twice is no loss.
  EXPECT_EQ(
      warnings,
      (std::map<Part::Kind, std::size_t>{
          {Part::kImage, 0}, {Part::kLines, 1}, {Part::kGroundTruth, 1}, {Part::kMatches, 1}}));
  ASSERT_GT(frames, 10U);
  ASSERT_EQ(pairs, 9U);
  Report report = stream.report(true);
  expectSeenIsTheSum(report.coverage);
  expectEqual(stream.coverage(), stream.report(false).coverage);
  EXPECT_EQ(report.coverage.dropped, frames);
  report.coverage.seen -= frames;
  report.coverage.dropped -= frames;
  report.pairs.skipped -= pairs;
  EXPECT_EQ(report.notes.size(), 3U + passOf(parts).report(true).notes.size());
  report.notes = passOf(parts).report(true).notes;
  EXPECT_EQ(textOf(report), reportOfOnePass(parts));
}

TEST(StreamEvaluator, AMessageWithoutAStampIsCountedAndToldOnce) {
  StreamEvaluator stream;
  std::vector<std::string> warnings;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(stream.addImage(0).warnings.empty());
    const EvaluationUpdate update = stream.addLines(handLines(0));
    warnings.insert(warnings.end(), update.warnings.begin(), update.warnings.end());
    EXPECT_FALSE(update.new_pass);
  }
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("without a stamp (0 s)"), std::string::npos) << warnings[0];
  stream.addLines(handLines(1));
  stream.addGroundTruth(handTruth(1));
  const Report report = stream.report(true);
  EXPECT_EQ(report.coverage.seen, 4U);
  EXPECT_EQ(report.coverage.dropped, 3U);
  EXPECT_EQ(report.coverage.evaluated, 1U);
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_EQ(report.notes[0].rfind("lines: ", 0), 0U) << report.notes[0];
}

TEST(StreamEvaluator, DepthAndPosesWithoutAStampAreCountedAndToldOnce) {
  StreamEvaluator stream;
  std::vector<std::string> warnings;
  for (int i = 0; i < 3; ++i) {
    EvaluationUpdate update = stream.addPose({0, Pose()});
    update.append(stream.addDepth(0, DepthMap(cv::Mat1f(2, 2, 1.0F))));
    warnings.insert(warnings.end(), update.warnings.begin(), update.warnings.end());
  }
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("poses_left_out"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("depth_left_out"), std::string::npos) << warnings[1];
  const Report report = stream.report(true);
  EXPECT_EQ(report.coverage.poses_left_out, 3U);
  EXPECT_EQ(report.coverage.depth_left_out, 3U);
  EXPECT_EQ(report.coverage.seen, 0U);
  EXPECT_EQ(stream.coverage().poses_left_out, 3U);
  EXPECT_EQ(report.notes.size(), 2U);
}

TEST(StreamEvaluator, TwoMethodsOnOneInputAreTold) {
  StreamEvaluator stream;
  std::vector<std::string> warnings;
  // One publisher is three frames ahead of the other.
  for (const auto& [stamp, source] : std::vector<std::pair<Stamp, std::string>>{{10, "ahead"},
                                                                                {11, "ahead"},
                                                                                {12, "ahead"},
                                                                                {10, "behind"},
                                                                                {13, "ahead"},
                                                                                {11, "behind"}}) {
    LineSet lines = handLines(stamp);
    lines.source = source;
    const EvaluationUpdate update = stream.addLines(lines);
    warnings.insert(warnings.end(), update.warnings.begin(), update.warnings.end());
  }
  EXPECT_EQ(stream.pass(), 2);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("0.00000001 s"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("'behind'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("'ahead'"), std::string::npos) << warnings[0];
}

TEST(StreamEvaluator, PartsOfAClosedPassAreCountedInTheOneThatRuns) {
  StreamEvaluator stream;
  stream.addLines(handLines(5));
  for (int pass = 1; pass <= 3; ++pass) {
    for (const Stamp stamp : {4, 5, 6}) stream.addImage(stamp);
  }
  ASSERT_EQ(stream.pass(), 3);
  const EvaluationUpdate update = stream.addLines(handLines(6));
  ASSERT_EQ(update.warnings.size(), 1U);
  EXPECT_NE(update.warnings[0].find("belongs to pass 1, in pass 3"), std::string::npos)
      << update.warnings[0];
  EXPECT_TRUE(stream.addLines(handLines(7)).warnings.empty());
  EXPECT_EQ(stream.coverage().seen, 5U);
  EXPECT_EQ(stream.coverage().dropped, 2U);
}

TEST(StreamEvaluator, AnInputThatStartsLateJoinsThePassThatRuns) {
  const std::vector<Part> parts = randomPass(7, 10);
  StreamEvaluator stream;
  for (const Part& part : parts) {
    if (part.kind != Part::kGroundTruth) give(part, &stream);
  }
  EXPECT_EQ(stream.coverage().evaluated, 0U);
  for (const Part& part : parts) {
    if (part.kind == Part::kGroundTruth) give(part, &stream);
  }
  EXPECT_EQ(stream.pass(), 1);
  EXPECT_EQ(textOf(stream.report(true)), reportOfOnePass(parts));

  // One that starts in the second pass does not go back to the first.
  StreamEvaluator looped;
  for (int pass = 1; pass <= 2; ++pass) {
    for (const Part& part : parts) {
      if (pass == 2 || part.kind != Part::kGroundTruth) give(part, &looped);
    }
  }
  EXPECT_EQ(looped.previousReport()->coverage.evaluated, 0U);
  EXPECT_EQ(textOf(looped.report(true)), reportOfOnePass(parts));
}

TEST(StreamEvaluator, ThePassBeforeChangesWithItsLastPartsAlone) {
  StreamEvaluator stream;
  for (const Stamp stamp : {1, 2, 3}) stream.addLines(handLines(stamp * kSecond));
  EXPECT_FALSE(stream.takePreviousChanged());
  stream.addLines(handLines(kSecond));
  EXPECT_EQ(stream.pass(), 2);
  EXPECT_TRUE(stream.takePreviousChanged()) << "it has become the one before";
  EXPECT_FALSE(stream.takePreviousChanged());
  stream.addLines(handLines(2 * kSecond));
  EXPECT_FALSE(stream.takePreviousChanged());
  stream.addGroundTruth(handTruth(kSecond));
  EXPECT_FALSE(stream.takePreviousChanged()) << "ground truth that starts late joins the newest";
}

TEST(StreamEvaluator, AJumpBackIsToldAfterAnyNumberOfFrames) {
  PassOptions options;
  options.families = {MetricFamily::kAssociation};
  StreamEvaluator stream(options);
  constexpr int kFrames = 3000;  // more than stamps are remembered
  for (int i = 1; i <= kFrames; ++i) stream.addLines(detected(i * kSecond, {}));
  EXPECT_EQ(stream.pass(), 1);
  stream.addLines(detected(kFrames * kSecond - 5 * kSecond + 1, {}));
  EXPECT_EQ(stream.pass(), 1) << "out of order";
  for (const Stamp first : {Stamp{1}, Stamp{1500}, Stamp{2999}}) {
    const int pass = stream.pass();
    stream.addLines(detected(first * kSecond, {}));
    EXPECT_EQ(stream.pass(), pass + 1) << first;
    for (int i = static_cast<int>(first) + 1; i <= kFrames; ++i) {
      stream.addLines(detected(i * kSecond, {}));
    }
    EXPECT_EQ(stream.pass(), pass + 1);
  }
}

TEST(StreamEvaluator, ResetForgetsPassesToo) {
  const std::vector<Part> parts = randomPass(9, 10);
  PassOptions options;
  options.evaluation.vectorized.distance_thresholds = {7};
  StreamEvaluator stream(options);
  for (int pass = 1; pass <= 3; ++pass) {
    for (const Part& part : parts) give(part, &stream);
  }
  stream.reset();
  EXPECT_EQ(stream.pass(), 1);
  EXPECT_EQ(stream.coverage().seen, 0U);
  EXPECT_FALSE(stream.previousReport().has_value());
  EXPECT_FALSE(stream.waiting());
  PassEvaluation reference(options);
  for (const Part& part : parts) {
    EXPECT_FALSE(give(part, &stream).new_pass);
    give(part, &reference);
  }
  EXPECT_EQ(textOf(stream.report(true)), textOf(reference.report(true)));
  EXPECT_EQ(stream.report(true).detection.size(), 2U);
}

TEST(StreamEvaluator, APassThatLeavesCountsItsUnfinishedTasks) {
  StreamEvaluator stream;
  EvaluationTask first_task;
  for (int pass = 1; pass <= 3; ++pass) {
    for (const Stamp stamp : {kSecond, 2 * kSecond}) {
      stream.addGroundTruth(test::handTruth(stamp));
      const EvaluationUpdate update = stream.addLines(test::handLines(stamp));
      ASSERT_EQ(update.tasks.size(), 1U);
      EXPECT_EQ(update.tasks[0].pass, pass);
      if (pass == 1) first_task = update.tasks[0];
    }
  }
  EXPECT_TRUE(stream.waiting());
  const std::optional<Report> released = stream.takeReleasedReport();
  ASSERT_TRUE(released.has_value());
  EXPECT_EQ(released->coverage.heatmap_skipped, 2U);
  EXPECT_EQ(released->heatmap.pending, 0U);
  // A result of the pass that is gone, or of before a reset, changes nothing.
  const EvaluationResult late = TaskRunner({}).run(first_task);
  EXPECT_TRUE(stream.addResult(late).heatmaps.empty());
  stream.reset();
  stream.addGroundTruth(test::handTruth(kSecond));
  stream.addLines(test::handLines(kSecond));
  EXPECT_TRUE(stream.addResult(late).heatmaps.empty());
  EXPECT_EQ(stream.report(true).heatmap.frames, 0U);
}

}  // namespace
}  // namespace evolin
