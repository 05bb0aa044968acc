// Time of rendering a synthetic frame, and of finding its ground-truth lines.
#include <benchmark/benchmark.h>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"

namespace evolin::synthetic {
namespace {

const SyntheticSequence& sequence() {
  static const SyntheticSequence kSequence{SyntheticOptions{}};
  return kSequence;
}

// Textures are baked when they are first seen: once before the clock starts.
void render(benchmark::State& state) {
  constexpr std::size_t kFrame = 45;
  const SequenceFrame warm = sequence().frame(kFrame);
  for (auto _ : state) {
    benchmark::DoNotOptimize(sequence().frame(kFrame));
  }
  state.counters["lines"] = static_cast<double>(warm.ground_truth->size());
}

void renderFirst(benchmark::State& state) {
  for (auto _ : state) {
    const SyntheticSequence fresh{SyntheticOptions{}};
    benchmark::DoNotOptimize(fresh.frame(0));
  }
}

void extractLines(benchmark::State& state) {
  std::size_t frame = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sequence().groundTruth(frame++ % sequence().size()));
  }
  state.counters["edges"] = static_cast<double>(sequence().scene().edges.size());
}

BENCHMARK(render)->Unit(benchmark::kMillisecond);
BENCHMARK(renderFirst)->Unit(benchmark::kMillisecond);
BENCHMARK(extractLines)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evolin::synthetic

BENCHMARK_MAIN();
