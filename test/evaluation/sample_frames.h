// Frames whose figures are computed by hand, and whole passes of random ones.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/pass_evaluation.h"
#include "evolin_ros/evaluation/report.h"
#include "test/metrics/vectorized_support.h"
#include "test/support/random_lines.h"

namespace evolin::test {

/// Lines keep their coordinates when they are scaled to 128 x 128.
constexpr int kSide = 128;
constexpr Stamp kSecond = kNanosecondsPerSecond;

/// As kStructural5: its place among the settings of the default options.
constexpr std::size_t kStructural10 = 4;

inline LineSegment line(double x1, double y1, double x2, double y2, double score = kNoScore,
                        std::int64_t id = kNoId) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  result.score = score;
  result.id = id;
  return result;
}

inline LineSet lineSet(Stamp stamp, const std::string& source, LineSegments lines) {
  LineSet set;
  set.stamp = stamp;
  set.source = source;
  set.width = kSide;
  set.height = kSide;
  set.scored =
      std::any_of(lines.begin(), lines.end(), [](const LineSegment& l) { return l.hasScore(); });
  set.lines = std::move(lines);
  return set;
}

inline LineSet detected(Stamp stamp, LineSegments lines) {
  return lineSet(stamp, "detector", std::move(lines));
}

inline LineSet annotated(Stamp stamp, LineSegments lines) {
  return lineSet(stamp, "ground_truth", std::move(lines));
}

/// Two annotated lines, 0 and 1.
inline LineSet handTruth(Stamp stamp) {
  return annotated(stamp, {line(10, 10, 50, 30, kNoScore, 0), line(60, 60, 100, 90, kNoScore, 1)});
}

/// The first annotated line as it is, the second moved by 3 pixels in x (structural distance 6,
/// orthogonal 3.6), and one far from both. Under 5 pixels two are hits by the orthogonal distance,
/// one by the structural; under 10 two by both.
inline LineSet handLines(Stamp stamp) {
  return detected(
      stamp, {line(10, 10, 50, 30, 0.9), line(63, 60, 103, 90, 0.8), line(10, 100, 40, 110, 0.7)});
}

inline PassOptions withBuffer(std::size_t buffer) {
  PassOptions options;
  options.buffer = buffer;
  return options;
}

inline MatchSet matchSet(Stamp first, Stamp second, const std::string& lines_source,
                         LineMatches matches) {
  MatchSet set;
  set.first_stamp = first;
  set.stamp = second;
  set.source = "associator";
  set.lines_source = lines_source;
  set.matches = std::move(matches);
  return set;
}

inline void expectSeenIsTheSum(const CoverageCounts& counts) {
  EXPECT_EQ(counts.seen, counts.waiting + counts.evaluated + counts.unmatched + counts.dropped +
                             counts.no_ground_truth + counts.bad_ground_truth + counts.skipped);
}

inline void expectEqual(const CoverageCounts& a, const CoverageCounts& b) {
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.waiting, b.waiting);
  EXPECT_EQ(a.evaluated, b.evaluated);
  EXPECT_EQ(a.unmatched, b.unmatched);
  EXPECT_EQ(a.dropped, b.dropped);
  EXPECT_EQ(a.no_ground_truth, b.no_ground_truth);
  EXPECT_EQ(a.bad_ground_truth, b.bad_ground_truth);
  EXPECT_EQ(a.skipped, b.skipped);
  EXPECT_EQ(a.no_depth, b.no_depth);
  EXPECT_EQ(a.no_pose, b.no_pose);
  EXPECT_EQ(a.waiting_depth, b.waiting_depth);
  EXPECT_EQ(a.waiting_pose, b.waiting_pose);
}

/// Everything in a report as one text; the number of the pass and the order of the notes, which is
/// that of arrival, are left out.
inline std::string textOf(Report report) {
  report.pass = 1;
  std::sort(report.notes.begin(), report.notes.end());
  return toJson(report) + toMarkdown(report) + framesToCsv(report) + pairsToCsv(report) +
         repeatabilityToCsv(report) + posesToCsv(report);
}

/// Everything that a stream may carry of one frame or pair.
struct Part {
  enum Kind { kImage, kLines, kGroundTruth, kMatches };
  Kind kind = kImage;
  Stamp stamp = 0;
  LineSet lines;
  MatchSet matches;
};

template <typename Evaluation>
EvaluationUpdate giveOnly(const Part& part, Evaluation* evaluation) {
  switch (part.kind) {
    case Part::kImage:
      return evaluation->addImage(part.stamp);
    case Part::kLines:
      return evaluation->addLines(part.lines);
    case Part::kGroundTruth:
      return evaluation->addGroundTruth(part.lines);
    case Part::kMatches:
      break;
  }
  return evaluation->addMatches(part.matches);
}

/// Does what an update asks for, at once.
template <typename Evaluation>
void runTasks(const TaskOptions& options, Evaluation* evaluation, EvaluationUpdate* update) {
  const TaskRunner runner(options);
  for (const EvaluationTask& task : std::exchange(update->tasks, {})) {
    update->append(evaluation->addResult(runner.run(task)));
  }
}

/// Adds the part and runs the tasks that it brings about.
template <typename Evaluation>
EvaluationUpdate give(const Part& part, Evaluation* evaluation) {
  EvaluationUpdate update = giveOnly(part, evaluation);
  runTasks({}, evaluation, &update);
  return update;
}

/// A pass of `frames` frames in order of time: random annotations, noisy detections with scores of
/// which some are equal, matches between annotations that are partly wrong. Of every ten frames
/// one has no annotation, one no detections, one an annotation without length, one an id twice, one
/// a ground truth of another image size.
inline std::vector<Part> randomPass(std::uint64_t seed, std::size_t frames) {
  RandomLines random(seed);
  std::vector<Part> parts;
  const auto add = [&parts](Part::Kind kind, Stamp stamp) -> Part& {
    parts.emplace_back();
    parts.back().kind = kind;
    parts.back().stamp = stamp;
    return parts.back();
  };
  for (std::size_t i = 0; i < frames; ++i) {
    const Stamp stamp = static_cast<Stamp>(i + 1) * kSecond;
    LineSegments truth = random.anywhere(5 + random.index(5), kSide - 1, kSide - 1);
    for (std::size_t row = 0; row < truth.size(); ++row) {
      truth[row].id = static_cast<std::int64_t>(row);
    }
    const LineSegments found = random.detectionsOf(truth, random.index(12), 6);
    add(Part::kImage, stamp);
    if (i % 10 != 3) {
      LineSet set = annotated(stamp, truth);
      if (i % 10 == 5) {
        set.lines[1].x2 = set.lines[1].x1;
        set.lines[1].y2 = set.lines[1].y1;
      }
      if (i % 10 == 7) {
        set.lines[1].id = 0;
      }
      set.width += i % 10 == 9 ? 1 : 0;
      add(Part::kGroundTruth, stamp).lines = set;
    }
    if (i % 10 != 4) {
      LineSet set = detected(stamp, found);
      set.processing_time = random.uniform(0.001, 0.1);
      add(Part::kLines, stamp).lines = set;
    }
    if (i > 0) {
      LineMatches matches(random.index(6));
      for (LineMatch& match : matches) {
        match.first = static_cast<std::uint32_t>(random.index(5));
        match.second =
            random.index(2) == 0 ? match.first : static_cast<std::uint32_t>(random.index(5));
      }
      MatchSet set = matchSet(stamp - kSecond, stamp, "ground_truth", matches);
      set.processing_time = random.uniform(0.001, 0.1);
      add(Part::kMatches, stamp).matches = set;
    }
  }
  return parts;
}

}  // namespace evolin::test
