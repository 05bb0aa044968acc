// Time and memory of each detector on one grey frame, and how both grow with its size.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "benchmark/frames.h"
#include "benchmark/peak_memory.h"
#include "evolin_ros/detection/cannylines.h"
#include "evolin_ros/detection/edlines.h"
#include "evolin_ros/detection/elsed.h"
#include "evolin_ros/detection/fld.h"
#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/kht.h"
#include "evolin_ros/detection/lsd.h"
#include "evolin_ros/detection/lswms.h"
#include "evolin_ros/detection/opencv_edlines.h"
#include "evolin_ros/detection/opencv_fld.h"
#include "evolin_ros/detection/opencv_lsd.h"

namespace evolin {
namespace {

template <typename Detector>
void detect(benchmark::State& state) {
  Detector detector;
  if (!detector.whyUnavailable().empty()) {
    state.SkipWithError(detector.whyUnavailable().c_str());
    return;
  }
  detector.configure(YAML::Node());
  const std::vector<Frame> frames = benchmark_frames::load();
  std::size_t next = 0;
  std::size_t lines = 0;
  for (auto _ : state) {
    lines += detector.detect(frames[next]).size();
    next = (next + 1) % frames.size();
  }
  state.counters["lines"] =
      benchmark::Counter(static_cast<double>(lines), benchmark::Counter::kAvgIterations);
}

/// With a new instance for every frame: no memory is warm.
template <typename Detector>
void detectAsNew(benchmark::State& state) {
  const std::vector<Frame> frames = benchmark_frames::load();
  std::size_t next = 0;
  for (auto _ : state) {
    Detector detector;
    detector.configure(YAML::Node());
    benchmark::DoNotOptimize(detector.detect(frames[next]));
    next = (next + 1) % frames.size();
  }
}

/// Of frames that are stretched to state.range(0) x state.range(1) pixels. "memory" is what the
/// detector and its lines take at most, the frames left out; bytes.
template <typename Detector>
void detectAtSize(benchmark::State& state) {
  const cv::Size size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  std::vector<Frame> frames = benchmark_frames::load();
  for (Frame& frame : frames) {
    cv::Mat stretched;
    cv::resize(frame.image, stretched, size, 0, 0, cv::INTER_CUBIC);
    frame.image = stretched;
  }
  std::optional<PeakMemory> memory;
  std::size_t lines = 0;
  std::size_t next = 0;
  {
    Detector detector;
    if (!detector.whyUnavailable().empty()) {
      state.SkipWithError(detector.whyUnavailable().c_str());
      return;
    }
    memory.emplace();
    detector.configure(YAML::Node());
    for (const Frame& frame : frames) {
      detector.detect(frame);
    }
    for (auto _ : state) {
      lines += detector.detect(frames[next]).size();
      next = (next + 1) % frames.size();
    }
  }
  const std::optional<double> bytes = memory->growth();
  if (bytes) {
    state.counters["memory"] =
        benchmark::Counter(*bytes, benchmark::Counter::kDefaults, benchmark::Counter::kIs1024);
  }
  state.counters["lines"] =
      benchmark::Counter(static_cast<double>(lines), benchmark::Counter::kAvgIterations);
}

void sizes(benchmark::internal::Benchmark* of) {
  of->Unit(benchmark::kMillisecond);
  of->Args({320, 240})->Args({640, 480})->Args({1280, 960})->Args({1920, 1080});
}

BENCHMARK_TEMPLATE(detect, Elsed)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detectAsNew, Elsed)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, CannyLines)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, EdLines)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, Fld)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, Fsg)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, Kht)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, Lsd)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, Lswms)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, OpenCvLsd)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, OpenCvEdLines)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, OpenCvFld)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(detect, HoughP)->Unit(benchmark::kMillisecond);

BENCHMARK_TEMPLATE(detectAtSize, CannyLines)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, EdLines)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Elsed)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Fld)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Fsg)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, HoughP)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Kht)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Lsd)->Apply(sizes);
BENCHMARK_TEMPLATE(detectAtSize, Lswms)->Apply(sizes);

}  // namespace
}  // namespace evolin

BENCHMARK_MAIN();
