// Time of the heatmap metrics on one thread: on the golden timing frames and the living-room sample
// where EVOLIN_SHARED is set, on generated frames otherwise.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/real_input.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/heatmap.h"
#include "test/support/random_lines.h"

namespace {

constexpr evolin::ImageSize kSize{640, 480};

struct FrameData {
  evolin::LineSegments predicted;
  evolin::LineSegments ground_truth;
  std::vector<double> thresholds;
};

/// A frame about as dense as the golden ones.
FrameData makeFrame(int true_lines, int near_lines, int other_lines) {
  evolin::test::RandomLines random(7);
  FrameData frame;
  for (int i = 0; i < true_lines; ++i) {
    evolin::LineSegment line;
    line.x1 = random.uniform(0, kSize.width);
    line.y1 = random.uniform(0, kSize.height);
    line.x2 = line.x1 + random.uniform(-200, 200);
    line.y2 = line.y1 + random.uniform(-200, 200);
    frame.ground_truth.push_back(line);
  }
  frame.predicted = random.detectionsOf(frame.ground_truth, near_lines, 6);
  for (evolin::LineSegment line : random.anywhere(other_lines, kSize.width, kSize.height)) {
    line.score = random.uniform(0, 0.5);
    frame.predicted.push_back(line);
  }
  return frame;
}

FrameData denseFrame(const std::string& stem) {
  const std::filesystem::path set = evolin::benchmark_input::realInput("data/golden/sets/timing");
  if (set.empty()) {
    FrameData frame = makeFrame(80, 350, 50);
    for (int i = 0; i < 20; ++i) {
      frame.thresholds.push_back(0.05 * i);
    }
    return frame;
  }
  const std::string file = stem + ".csv";
  return {evolin::readScoredLinesCsv(set / "scored_lines" / "lines" / file,
                                     set / "scored_lines" / "scores" / file),
          evolin::readLinesCsv(set / "gt_lines" / file),
          evolin::readNumbers(set / "scored_lines" / "score_thresholds.txt")};
}

FrameData livingRoomFrame() {
  const std::filesystem::path sample =
      evolin::benchmark_input::realInput("data/icl_nuim_lr_sample");
  if (sample.empty()) {
    return makeFrame(57, 100, 17);
  }
  return {evolin::readLinesCsv(sample / "predictions" / "unscored" / "0000.csv"),
          evolin::readLinesCsv(sample / "gt_lines" / "0000.csv"),
          {}};
}

void measure(const FrameData& frame, benchmark::State* state) {
  for (auto _ : *state) {
    evolin::HeatmapMetrics metrics(evolin::HeatmapOptions{frame.thresholds});
    metrics.addFrame(0, "0000", kSize, frame.predicted, frame.ground_truth);
    benchmark::DoNotOptimize(metrics.summary());
  }
}

void averagePrecisionOfDenseFrame(benchmark::State& state) {
  const std::string digits = std::to_string(state.range(0));
  measure(denseFrame(std::string(4 - digits.size(), '0') + digits), &state);
}
// Two of the usual ones, one of the longest searches, and one proven after exchanges only.
BENCHMARK(averagePrecisionOfDenseFrame)
    ->Arg(0)
    ->Arg(30)
    ->Arg(39)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond);

void classificationOfLivingRoomFrame(benchmark::State& state) {
  measure(livingRoomFrame(), &state);
}
BENCHMARK(classificationOfLivingRoomFrame)->Unit(benchmark::kMillisecond);

/// One more frame after range(0) others: the time must not depend on their number.
void addFrameAfterOthers(benchmark::State& state) {
  const FrameData frame = makeFrame(4, 6, 0);
  evolin::HeatmapMetrics metrics;
  std::uint32_t number = 0;
  for (; number < state.range(0); ++number) {
    metrics.addFrame(number, "before", kSize, frame.predicted, frame.ground_truth);
  }
  for (auto _ : state) {
    metrics.addFrame(number++, "next", kSize, frame.predicted, frame.ground_truth);
    benchmark::DoNotOptimize(metrics.classification().fScore());
  }
}
BENCHMARK(addFrameAfterOthers)
    ->Arg(60)
    ->Arg(600)
    ->Arg(6000)
    ->Iterations(500)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
