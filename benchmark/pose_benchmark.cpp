// Time of one relative pose in one direction, both strategies, 57 matches (or 250), one thread:
// a drawn scene, and the published solver's own inputs where EVOLIN_SHARED is set.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "evolin_ros/pose/evolin_pose.h"
#include "evolin_ros/pose/robust_pose.h"
#include "test/pose/golden_pairs.h"
#include "test/pose/line_scene.h"

namespace {

constexpr std::size_t kMatches = 57;
constexpr std::size_t kManyMatches = 250;  ///< as many as the built-in sequence has a pair

struct Inputs {
  evolin::Camera camera;
  std::vector<evolin::SpatialMatches> sets;
};

Inputs drawnInputs(double noise, double wrong, std::size_t count = kMatches) {
  Inputs inputs{evolin::test::pinhole(481.2, -480, 319.5, 239.5), {}};
  const evolin::Pose motion = evolin::test::motionOf({0.02, -0.01, 0.015}, {0.04, -0.02, 0.03});
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    evolin::test::RandomLines random(seed);
    evolin::SpatialMatches matches =
        evolin::test::observe(evolin::test::randomSegments(count, &random), motion, inputs.camera);
    evolin::test::addNoise(noise, inputs.camera, &random, &matches);
    evolin::test::makeWrong(wrong, &random, &matches);
    inputs.sets.push_back(std::move(matches));
  }
  return inputs;
}

/// Noise and wrong matches on top of the nine pairs of the living room.
Inputs goldenInputs(double noise, double wrong) {
  const evolin::test::GoldenPairs golden = evolin::test::goldenLivingRoom();
  Inputs inputs{golden.camera, {}};
  for (const evolin::test::GoldenPair& pair : golden.pairs) {
    evolin::test::RandomLines random(inputs.sets.size());
    evolin::SpatialMatches matches = pair.matches;
    evolin::test::addNoise(noise, inputs.camera, &random, &matches);
    evolin::test::makeWrong(wrong, &random, &matches);
    inputs.sets.push_back(std::move(matches));
  }
  return inputs;
}

template <typename Estimator>
void run(benchmark::State& state, const Inputs& inputs) {
  const Estimator estimator;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimator.estimate(inputs.sets[next], inputs.camera));
    next = (next + 1) % inputs.sets.size();
  }
}

void evolinDrawn(benchmark::State& state) {
  run<evolin::EvolinPoseEstimator>(state, drawnInputs(0, 0));
}
BENCHMARK(evolinDrawn)->Unit(benchmark::kMillisecond);

/// Most of the schedule's rounds have matches to remove here.
void evolinDrawnMany(benchmark::State& state) {
  run<evolin::EvolinPoseEstimator>(state, drawnInputs(0.3, 0.02, kManyMatches));
}
BENCHMARK(evolinDrawnMany)->Unit(benchmark::kMillisecond);

void robustDrawn(benchmark::State& state) {
  run<evolin::RobustPoseEstimator>(state,
                                   drawnInputs(1, static_cast<double>(state.range(0)) / 100));
}
BENCHMARK(robustDrawn)->ArgName("wrong %")->Arg(0)->Arg(30)->Arg(60)->Unit(benchmark::kMillisecond);

void evolinLivingRoom(benchmark::State& state) {
  if (evolin::test::sharedFolder().empty()) {
    state.SkipWithError("EVOLIN_SHARED is unset");
    return;
  }
  run<evolin::EvolinPoseEstimator>(state, goldenInputs(0, 0));
}
BENCHMARK(evolinLivingRoom)->Unit(benchmark::kMillisecond);

void robustLivingRoom(benchmark::State& state) {
  if (evolin::test::sharedFolder().empty()) {
    state.SkipWithError("EVOLIN_SHARED is unset");
    return;
  }
  run<evolin::RobustPoseEstimator>(state, goldenInputs(static_cast<double>(state.range(1)),
                                                       static_cast<double>(state.range(0)) / 100));
}
BENCHMARK(robustLivingRoom)
    ->ArgNames({"wrong %", "noise"})
    ->Args({0, 0})
    ->Args({30, 0})
    ->Args({30, 1})
    ->Args({60, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
