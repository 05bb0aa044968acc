// Time of one more frame of a live evaluation after so many others, all families without depth and
// poses: it must not grow with them.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <utility>
#include <variant>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/support/random_lines.h"

namespace {

constexpr evolin::Stamp kPeriod = evolin::kNanosecondsPerSecond / 30;
constexpr int kTrueLines = 20;
constexpr int kLines = 100;

/// One frame after the other; heatmaps are not measured but come back empty, as their cost has a
/// benchmark of its own.
class LivePass {
 public:
  LivePass() : pass_(options()) {
    truth_ = random_.anywhere(kTrueLines, 640, 480);
    for (std::size_t row = 0; row < truth_.size(); ++row) {
      truth_[row].id = static_cast<std::int64_t>(row);
    }
  }

  void addFrame() {
    stamp_ += kPeriod;
    take(pass_.addImage(stamp_));
    take(pass_.addGroundTruth(set("truth", truth_)));
    take(pass_.addLines(set("detector", random_.detectionsOf(truth_, kLines, 5))));
    evolin::MatchSet matches;
    matches.first_stamp = stamp_ - kPeriod;
    matches.stamp = stamp_;
    matches.source = "associator";
    matches.lines_source = "detector";
    for (std::uint32_t row = 0; row < kLines; ++row) {
      matches.matches.push_back({row, row});
    }
    take(pass_.addMatches(std::move(matches)));
  }

  std::size_t evaluated() const { return pass_.coverage().evaluated; }

 private:
  static evolin::PassOptions options() {
    evolin::PassOptions options;
    options.buffer = 50;
    return options;
  }

  evolin::LineSet set(const char* source, evolin::LineSegments lines) const {
    evolin::LineSet set;
    set.stamp = stamp_;
    set.source = source;
    set.width = 640;
    set.height = 480;
    set.scored = lines.front().hasScore();
    set.lines = std::move(lines);
    return set;
  }

  void take(const evolin::EvaluationUpdate& update) {
    for (const evolin::EvaluationTask& task : update.tasks) {
      evolin::HeatmapRecord record;
      record.stamp = std::get<evolin::HeatmapTask>(task.work).stamp;
      record.counts.resize(1);
      pass_.addResult({0, 0, record});
    }
  }

  evolin::test::RandomLines random_{7};
  evolin::PassEvaluation pass_;
  evolin::LineSegments truth_;
  evolin::Stamp stamp_ = evolin::kNanosecondsPerSecond;
};

void addFrameAfterMany(benchmark::State& state) {
  LivePass pass;
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    pass.addFrame();
  }
  for (auto _ : state) {
    pass.addFrame();
  }
  if (pass.evaluated() < static_cast<std::size_t>(state.range(0))) {
    state.SkipWithError("frames were not evaluated");
  }
}
BENCHMARK(addFrameAfterMany)
    ->Arg(60)
    ->Arg(600)
    ->Arg(6000)
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
