// Time of the learned detectors, stage by stage, on real frames; and of decoding alone, from the
// golden maps. Needs EVOLIN_SHARED, and for whole frames the model files (EVOLIN_MODELS).
#include <benchmark/benchmark.h>

#include <opencv2/imgcodecs.hpp>

#include "benchmark/real_input.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/lsdnet.h"
#include "evolin_ros/detection/mlsd.h"
#include "lsdnet_decoding.h"
#include "mlsd_decoding.h"
#include "test/support/npy.h"

namespace evolin {
namespace {

std::vector<Frame> colourFrames() {
  std::vector<Frame> frames;
  const std::filesystem::path folder = benchmark_input::realInput("data/icl_nuim_lr_sample/rgb");
  for (int i = 0; i < 6 && !folder.empty(); ++i) {
    Frame frame;
    frame.image = cv::imread((folder / ("000" + std::to_string(i) + ".png")).string());
    frames.push_back(frame);
  }
  return frames;
}

template <typename Detector>
void detect(benchmark::State& state, const std::string& parameters) {
  Detector detector;
  const std::vector<Frame> frames = colourFrames();
  try {
    detector.configure(YAML::Load(parameters));
  } catch (const Error& error) {
    state.SkipWithError(error.what());
    return;
  }
  if (frames.empty()) {
    state.SkipWithError("no frames without EVOLIN_SHARED");
    return;
  }
  std::size_t next = 0;
  NetworkTimes sum;
  for (auto _ : state) {
    benchmark::DoNotOptimize(detector.detect(frames[next++ % frames.size()]));
    sum.preparing += detector.times().preparing;
    sum.forward += detector.times().forward;
    sum.decoding += detector.times().decoding;
  }
  const auto average = benchmark::Counter::kAvgIterations;
  state.counters["preparing_ms"] = benchmark::Counter(sum.preparing, average);
  state.counters["forward_ms"] = benchmark::Counter(sum.forward, average);
  state.counters["decoding_ms"] = benchmark::Counter(sum.decoding, average);
}

template <typename Decoder, typename Options>
void decode(benchmark::State& state, const std::string& maps_folder, const Options& options) {
  const std::filesystem::path folder =
      benchmark_input::realInput("data/golden/networks/" + maps_folder);
  if (folder.empty()) {
    state.SkipWithError("no maps without EVOLIN_SHARED");
    return;
  }
  const std::vector<cv::Mat> maps = {test::readNpy(folder / "icl_0000.npy"),
                                     test::readNpy(folder / "icl_0001.npy")};
  Decoder decoder(options);
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(decoder.decode(maps[next++ % 2], cv::Size(640, 480)));
  }
}

void mlsdTiny512(benchmark::State& state) { detect<Mlsd>(state, "{}"); }

void mlsdTiny320(benchmark::State& state) { detect<Mlsd>(state, "{model: mlsd_tiny_320.onnx}"); }

void mlsdLarge512(benchmark::State& state) { detect<Mlsd>(state, "{model: mlsd_large_512.onnx}"); }

void lsdNet(benchmark::State& state) { detect<LsdNet>(state, "{}"); }

void mlsdDecoding(benchmark::State& state) {
  decode<mlsd::Decoder>(state, "mlsd_tiny_512/tpmap", mlsd::DecodingOptions());
}

void lsdNetDecoding(benchmark::State& state) {
  decode<lsdnet::Decoder>(state, "lsdnet/net", lsdnet::DecodingOptions());
}

void lsdNetSinglePassDecoding(benchmark::State& state) {
  decode<lsdnet::Decoder>(state, "lsdnet/net", lsdnet::DecodingOptions{false, true});
}

BENCHMARK(mlsdDecoding)->Unit(benchmark::kMillisecond);
BENCHMARK(lsdNetDecoding)->Unit(benchmark::kMillisecond);
BENCHMARK(lsdNetSinglePassDecoding)->Unit(benchmark::kMillisecond);
BENCHMARK(mlsdTiny512)->Unit(benchmark::kMillisecond);
BENCHMARK(mlsdTiny320)->Unit(benchmark::kMillisecond);
BENCHMARK(mlsdLarge512)->Unit(benchmark::kMillisecond);
BENCHMARK(lsdNet)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evolin

BENCHMARK_MAIN();
