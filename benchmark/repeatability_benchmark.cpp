// Time of repeatability and localisation error: 60 frames in pairs of neighbours, two distances
// with three thresholds, one thread, on the golden timing set where EVOLIN_SHARED names the real
// samples, else on random lines before a wavy wall. Decoding of files is not measured.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/real_input.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/image_file.h"
#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/metrics/best_localization.h"
#include "evolin_ros/metrics/one_to_one_repeatability.h"
#include "evolin_ros/metrics/repeatability.h"
#include "test/support/random_lines.h"

namespace {

constexpr int kFrames = 60;
constexpr int kStep = 1;
constexpr double kScoreThreshold = 0.4;  // that of the golden set's headline values

struct FrameData {
  std::string name;
  evolin::LineSegments lines;
  cv::Mat depth;  // 16 bit
  evolin::Pose pose;
};

struct Sequence {
  evolin::Camera camera;
  std::vector<FrameData> frames;
};

Sequence readTimingSet(const std::filesystem::path& folder) {
  Sequence sequence;
  sequence.camera = evolin::readCalibrationMatrix(folder / "calibration_matrix.txt");
  const std::vector<evolin::Pose> poses = evolin::readPoseRows(folder / "poses.txt");
  const std::filesystem::path scored = folder / "scored_lines";
  for (const auto& file : evolin::listFiles(scored / "lines", {".csv"})) {
    const std::string stem = file.stem().string();
    FrameData frame;
    frame.name = stem;
    frame.lines = evolin::readScoredLinesCsv(file, scored / "scores" / (stem + ".csv"));
    frame.depth = evolin::readStoredDepth(folder / "depth" / (stem + ".png"));
    frame.pose = poses.at(sequence.frames.size());
    sequence.frames.push_back(std::move(frame));
  }
  return sequence;
}

Sequence makeSequence() {
  Sequence sequence;
  sequence.camera.fx = sequence.camera.fy = 525;
  sequence.camera.cx = 319.5;
  sequence.camera.cy = 239.5;
  evolin::test::RandomLines random(7);
  const evolin::LineSegments world = random.anywhere(400, 640, 480);
  cv::Mat depth(480, 640, CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      depth.at<std::uint16_t>(y, x) =
          static_cast<std::uint16_t>(5000 * (2 + 0.2 * std::sin(x / 40.0) * std::cos(y / 50.0)));
    }
  }
  for (int number = 0; number < kFrames; ++number) {
    FrameData frame;
    frame.name = std::to_string(number);
    frame.lines = random.detectionsOf(world, 400, 15);
    frame.depth = depth;
    frame.pose.translation.x() = 0.01 * number;
    sequence.frames.push_back(std::move(frame));
  }
  return sequence;
}

const Sequence& sequence() {
  static const Sequence kSequence = [] {
    const std::filesystem::path set = evolin::benchmark_input::realInput("data/golden/sets/timing");
    return set.empty() ? makeSequence() : readTimingSet(set);
  }();
  return kSequence;
}

std::vector<evolin::SpatialFrame> liftAll() {
  std::vector<evolin::SpatialFrame> frames;
  frames.reserve(sequence().frames.size());
  for (const FrameData& frame : sequence().frames) {
    frames.push_back(evolin::liftLines(evolin::Protocol::kEvolin, frame.name, frame.lines,
                                       evolin::DepthMap(frame.depth), sequence().camera,
                                       frame.pose));
  }
  return frames;
}

evolin::RepeatabilityMetrics makeMetrics(bool filtered) {
  evolin::RepeatabilityOptions options;
  options.frame_steps = {kStep};
  if (filtered) {
    options.score_thresholds = {kScoreThreshold};
  }
  return evolin::RepeatabilityMetrics(options);
}

/// Lifting, projection, 6 settings and the figures of the whole sequence; the argument says whether
/// the lines above the score threshold alone count.
void repeatabilityOfSequence(benchmark::State& state) {
  const bool filtered = state.range(0) != 0;
  sequence();
  for (auto _ : state) {
    const std::vector<evolin::SpatialFrame> frames = liftAll();
    evolin::RepeatabilityMetrics metrics = makeMetrics(filtered);
    for (std::size_t second = kStep; second < frames.size(); ++second) {
      metrics.addPair(kStep, frames[second - kStep], frames[second]);
    }
    for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
      benchmark::DoNotOptimize(metrics.figures(setting));
    }
  }
}
BENCHMARK(repeatabilityOfSequence)
    ->ArgName("filtered")
    ->Arg(1)
    ->Arg(0)
    ->Unit(benchmark::kMillisecond);

/// The cost of one more pair after so many others.
void addPairAfterMany(benchmark::State& state) {
  const std::vector<evolin::SpatialFrame> frames = liftAll();
  evolin::RepeatabilityMetrics metrics = makeMetrics(false);
  const auto first = metrics.measure(frames[0], frames[1]);
  for (int pair = 0; pair < state.range(0); ++pair) {
    metrics.add(kStep, first);
  }
  for (auto _ : state) {
    metrics.addPair(kStep, frames[0], frames[1]);
    for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
      benchmark::DoNotOptimize(metrics.figures(setting));
    }
  }
}
BENCHMARK(addPairAfterMany)->Arg(60)->Arg(600)->Arg(6000)->Unit(benchmark::kMicrosecond);

void oneToOneRepeatabilityOfSequence(benchmark::State& state) {
  const std::vector<evolin::SpatialFrame> frames = liftAll();
  for (auto _ : state) {
    evolin::OneToOneRepeatability metric;
    for (std::size_t second = kStep; second < frames.size(); ++second) {
      metric.addPair(frames[second - kStep], frames[second]);
    }
    benchmark::DoNotOptimize(metric.byLength());
  }
}
BENCHMARK(oneToOneRepeatabilityOfSequence)->Unit(benchmark::kMillisecond);

void bestLocalizationOfSequence(benchmark::State& state) {
  const std::vector<evolin::SpatialFrame> frames = liftAll();
  for (auto _ : state) {
    evolin::BestLocalization metric;
    for (std::size_t second = kStep; second < frames.size(); ++second) {
      metric.addPair(frames[second - kStep], frames[second]);
    }
    benchmark::DoNotOptimize(metric.error());
  }
}
BENCHMARK(bestLocalizationOfSequence)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
