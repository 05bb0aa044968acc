// Time of the association metric: 59 pairs of frames of 80 true and 80 predicted matches, one
// thread.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

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

void addPairs(benchmark::State& state) {
  const std::vector<PairData> pairs = makePairs();
  for (auto _ : state) {
    evolin::AssociationMetrics metrics;
    for (const PairData& pair : pairs) {
      metrics.addPair(pair.predicted, pair.truth);
    }
    benchmark::DoNotOptimize(metrics.classification());
  }
}
BENCHMARK(addPairs)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
