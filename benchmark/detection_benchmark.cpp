// Time of each detector on one grey frame.
#include <benchmark/benchmark.h>

#include "benchmark/frames.h"
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

}  // namespace
}  // namespace evolin

BENCHMARK_MAIN();
