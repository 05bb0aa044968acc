// Time of the association metric: 59 pairs of frames, one thread, on the golden timing set where
// EVOLIN_SHARED names the real samples, else of 80 true and 80 predicted random matches.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "benchmark/real_input.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/association.h"
#include "test/support/random_lines.h"

namespace {

constexpr int kPairs = 59;
constexpr std::int64_t kMatches = 80;

struct PairData {
  evolin::IndexPairs predicted;
  evolin::IndexPairs truth;
};

/// Three of four predicted matches are right.
std::vector<PairData> makePairs() {
  evolin::test::RandomLines random(7);
  std::vector<PairData> pairs(kPairs);
  for (PairData& pair : pairs) {
    for (std::int64_t row = 0; row < kMatches; ++row) {
      const bool wrong = random.index(4) == 0;
      pair.truth.emplace_back(row, kMatches - 1 - row);
      pair.predicted.emplace_back(
          row, wrong ? static_cast<std::int64_t>(random.index(kMatches)) : kMatches - 1 - row);
    }
  }
  return pairs;
}

std::vector<PairData> loadPairs() {
  const std::filesystem::path set = evolin::benchmark_input::realInput("data/golden/sets/timing");
  if (set.empty()) {
    return makePairs();
  }
  std::vector<PairData> pairs;
  for (const auto& file : evolin::listFiles(set / "gt_associations", {".csv"})) {
    pairs.push_back({evolin::readIndexPairsCsv(set / "pred_associations" / file.filename()),
                     evolin::readIndexPairsCsv(file)});
  }
  return pairs;
}

void addPairs(benchmark::State& state) {
  const std::vector<PairData> pairs = loadPairs();
  for (auto _ : state) {
    evolin::AssociationMetrics metrics;
    for (const PairData& pair : pairs) {
      metrics.addPair(pair.predicted, pair.truth);
    }
    benchmark::DoNotOptimize(metrics.classification());
  }
}
BENCHMARK(addPairs)->Unit(benchmark::kMicrosecond);

/// One more pair after so many others: its cost must not grow with them.
void addPairAfterMany(benchmark::State& state) {
  const std::vector<PairData> pairs = loadPairs();
  evolin::AssociationMetrics metrics;
  std::size_t next = 0;
  const auto add = [&] {
    const PairData& pair = pairs[next++ % pairs.size()];
    metrics.addPair(pair.predicted, pair.truth);
  };
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    add();
  }
  for (auto _ : state) {
    add();
    benchmark::DoNotOptimize(metrics.classification());
  }
}
BENCHMARK(addPairAfterMany)
    ->Arg(60)
    ->Arg(600)
    ->Arg(6000)
    ->Iterations(590)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
