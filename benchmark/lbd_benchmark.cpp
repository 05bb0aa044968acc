// Time of describing the lines of a frame with LBD, float and binary, and of matching two frames.
#include <benchmark/benchmark.h>

#include "benchmark/frames.h"
#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/association/lbd_associator.h"
#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/lbd_binary_descriptor.h"
#include "evolin_ros/association/lbd_descriptor.h"
#include "evolin_ros/association/opencv_lbd_binary.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/opencv_lsd.h"

namespace evolin {
namespace {

// Detected lines of a frame; by Hough where this build lacks LSD.
LineSegments detectLines(const Frame& frame) {
  OpenCvLsd lsd;
  if (lsd.whyUnavailable().empty()) {
    lsd.configure(YAML::Node());
    return lsd.detect(frame);
  }
  HoughP hough;
  hough.configure(YAML::Load("{threshold: 20, min_length: 15}"));
  return hough.detect(frame);
}

void describe(benchmark::State& state) {
  const Frame frame = benchmark_frames::load().front();
  const LineSegments lines = detectLines(frame);
  for (auto _ : state) {
    benchmark::DoNotOptimize(describeLbd(frame.image, lines));
  }
  state.counters["lines"] = static_cast<double>(lines.size());
}

void describeBinary(benchmark::State& state) {
  const Frame frame = benchmark_frames::load().front();
  const LineSegments lines = detectLines(frame);
  for (auto _ : state) {
    benchmark::DoNotOptimize(describeLbdBinary(frame.image, lines));
  }
  state.counters["lines"] = static_cast<double>(lines.size());
}

void describeOpenCvBinary(benchmark::State& state) {
  if (!whyNoOpenCvLbdBinary().empty()) {
    state.SkipWithError(whyNoOpenCvLbdBinary().c_str());
    return;
  }
  const Frame frame = benchmark_frames::load().front();
  const LineSegments lines = detectLines(frame);
  for (auto _ : state) {
    benchmark::DoNotOptimize(describeOpenCvLbdBinary(frame.image, lines));
  }
  state.counters["lines"] = static_cast<double>(lines.size());
}

void match(benchmark::State& state) {
  const std::vector<Frame> frames = benchmark_frames::load();
  const cv::Mat first = describeLbd(frames[0].image, detectLines(frames[0]));
  const cv::Mat second = describeLbd(frames[1].image, detectLines(frames[1]));
  for (auto _ : state) {
    benchmark::DoNotOptimize(matchDescriptors(first, second, MatchingRules()));
  }
  state.counters["lines"] = static_cast<double>(first.rows);
}

void matchBinary(benchmark::State& state) {
  const std::vector<Frame> frames = benchmark_frames::load();
  const BinaryDescriptors first = describeLbdBinary(frames[0].image, detectLines(frames[0]));
  const BinaryDescriptors second = describeLbdBinary(frames[1].image, detectLines(frames[1]));
  for (auto _ : state) {
    benchmark::DoNotOptimize(matchBinaryDescriptors(first, second, MatchingRules()));
  }
  state.counters["lines"] = static_cast<double>(first.bits.rows);
}

// A frame of a stream: its own lines are described, those of the frame before are known.
template <typename Associator>
void describeAndMatch(benchmark::State& state) {
  Associator associator;
  if (!associator.whyUnavailable().empty()) {
    state.SkipWithError(associator.whyUnavailable().c_str());
    return;
  }
  associator.configure(YAML::Node());
  const std::vector<Frame> frames = benchmark_frames::load();
  FrameLines first;
  first.frame = frames[0];
  first.lines = detectLines(first.frame);
  FrameLines second;
  second.frame = frames[1];
  second.lines = detectLines(second.frame);
  std::size_t matches = 0;
  for (auto _ : state) {
    second.description.reset();
    matches = associator.match(first, second).size();
  }
  state.counters["lines"] = static_cast<double>(second.lines.size());
  state.counters["matches"] = static_cast<double>(matches);
}

BENCHMARK(describe)->Unit(benchmark::kMillisecond);
BENCHMARK(describeBinary)->Unit(benchmark::kMillisecond);
BENCHMARK(describeOpenCvBinary)->Unit(benchmark::kMillisecond);
BENCHMARK(match)->Unit(benchmark::kMillisecond);
BENCHMARK(matchBinary)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(describeAndMatch, LbdAssociator)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(describeAndMatch, LbdBinaryAssociator)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(describeAndMatch, OpenCvLbdBinaryAssociator)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evolin

BENCHMARK_MAIN();
