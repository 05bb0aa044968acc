// Time of the vectorized detection metric: 60 frames of about 400 predictions and 80 true lines, 6
// settings, one thread, on the golden timing set where EVOLIN_SHARED names the real samples, else
// on random lines.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/real_input.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/resampled_precision.h"
#include "evolin_ros/metrics/vectorized.h"
#include "test/support/random_lines.h"

namespace {

constexpr evolin::ImageSize kSize{640, 480};
constexpr int kFrames = 60;
constexpr int kPredictions = 400;
constexpr int kTrueLines = 80;

struct FrameData {
  evolin::LineSegments predicted;
  evolin::LineSegments ground_truth;
};

std::vector<FrameData> makeSequence() {
  evolin::test::RandomLines random(7);
  std::vector<FrameData> frames(kFrames);
  for (FrameData& frame : frames) {
    frame.ground_truth = random.anywhere(kTrueLines, kSize.width, kSize.height);
    frame.predicted = random.detectionsOf(frame.ground_truth, kPredictions / 2, 20);
    for (evolin::LineSegment line :
         random.anywhere(kPredictions - kPredictions / 2, kSize.width, kSize.height)) {
      line.score = random.uniform(0, 0.5);
      frame.predicted.push_back(line);
    }
  }
  return frames;
}

std::vector<FrameData> readTimingSet(const std::filesystem::path& folder) {
  std::vector<FrameData> frames;
  const std::filesystem::path scored = folder / "scored_lines";
  for (const auto& file : evolin::listFiles(scored / "lines", {".csv"})) {
    frames.push_back({evolin::readScoredLinesCsv(file, scored / "scores" / file.filename()),
                      evolin::readLinesCsv(folder / "gt_lines" / file.filename())});
  }
  return frames;
}

std::vector<FrameData> loadSequence() {
  const std::filesystem::path set = evolin::benchmark_input::realInput("data/golden/sets/timing");
  return set.empty() ? makeSequence() : readTimingSet(set);
}

evolin::VectorizedMetrics measure(const std::vector<FrameData>& frames) {
  evolin::VectorizedMetrics metrics;
  for (std::uint32_t number = 0; number < frames.size(); ++number) {
    metrics.addFrame(number, std::to_string(number), kSize, frames[number].predicted,
                     frames[number].ground_truth, true);
  }
  return metrics;
}

void addFrames(benchmark::State& state) {
  const std::vector<FrameData> frames = loadSequence();
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure(frames));
  }
}
BENCHMARK(addFrames)->Unit(benchmark::kMillisecond);

void addFramesAndReadEverything(benchmark::State& state) {
  const std::vector<FrameData> frames = loadSequence();
  for (auto _ : state) {
    const evolin::VectorizedMetrics metrics = measure(frames);
    for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
      benchmark::DoNotOptimize(metrics.classification(setting));
    }
    benchmark::DoNotOptimize(metrics.averagePrecisions());
  }
}
BENCHMARK(addFramesAndReadEverything)->Unit(benchmark::kMillisecond);

/// A fourth of the thousand resamples that intervals are made of.
void resampleAveragePrecisions(benchmark::State& state) {
  const evolin::VectorizedMetrics metrics = measure(loadSequence());
  evolin::ResampledPrecision resampled(metrics.ranking());
  std::vector<std::uint32_t> weights(metrics.frames());
  for (std::size_t frame = 0; frame < weights.size(); ++frame) {
    weights[frame] = static_cast<std::uint32_t>(frame * 7 % 5 / 2);  // 0 to 2
  }
  const std::vector<std::vector<std::uint32_t>> resamples(250, weights);
  for (auto _ : state) {
    benchmark::DoNotOptimize(resampled.averagePrecisions(resamples));
  }
}
BENCHMARK(resampleAveragePrecisions)->Unit(benchmark::kMicrosecond);

/// One more frame after so many others: its cost must not grow with them.
void addFrameAfterMany(benchmark::State& state) {
  const std::vector<FrameData> frames = loadSequence();
  evolin::VectorizedMetrics metrics;
  std::uint32_t number = 0;
  const auto add = [&] {
    const FrameData& frame = frames[number % frames.size()];
    metrics.addFrame(number++, "frame", kSize, frame.predicted, frame.ground_truth, true);
  };
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    add();
  }
  // A fixed number, so that every case ends with nearly as many frames as it began.
  for (auto _ : state) {
    add();
  }
}
BENCHMARK(addFrameAfterMany)
    ->Arg(60)
    ->Arg(600)
    ->Arg(6000)
    ->Iterations(60)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
