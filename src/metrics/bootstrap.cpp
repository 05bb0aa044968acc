// Circular block bootstrap with percentile intervals.
#include "evolin_ros/metrics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// Their weights fit into the processor's caches for sequences of usual length.
constexpr int kResamplesAtOnce = 256;

void validate(std::size_t frames, const BootstrapOptions& options) {
  if (frames == 0) {
    throw Error("bootstrap: no frames to draw from");
  }
  if (options.resamples < 1) {
    throw Error("bootstrap: " + std::to_string(options.resamples) +
                " resamples; expected at least 1");
  }
  if (options.block_length < 0 || static_cast<std::size_t>(options.block_length) > frames) {
    throw Error("bootstrap: block length " + std::to_string(options.block_length) +
                "; expected 0 (automatic) to " + std::to_string(frames) + ", the number of frames");
  }
  if (!(options.level > 0) || !(options.level < 1)) {
    throw Error("bootstrap: level " + formatDouble(options.level) +
                "; expected a number between 0 and 1");
  }
}

/// Frames at random. The standard's distributions differ from library to library.
class FrameDraw {
 public:
  FrameDraw(std::size_t frames, std::uint64_t seed)
      : generator_(seed), frames_(frames), last_(kLargest - (kLargest % frames + 1) % frames) {}

  /// Uniform in [0, frames).
  std::size_t operator()() {
    std::uint64_t value = generator_();
    while (value > last_) {
      value = generator_();
    }
    return static_cast<std::size_t>(value % frames_);
  }

 private:
  static constexpr std::uint64_t kLargest = std::mt19937_64::max();

  std::mt19937_64 generator_;
  std::uint64_t frames_;
  std::uint64_t last_;  ///< number below which every frame has the same share
};

std::size_t automaticBlockLength(std::size_t frames) {
  std::size_t length = 1;
  while (length * length * length < frames) {
    ++length;
  }
  return length;
}

/// How often each of `frames` occurs in a row of blocks.
std::vector<std::uint32_t> drawWeights(std::size_t frames, std::size_t block, FrameDraw* draw) {
  std::vector<std::uint32_t> weights(frames, 0);
  for (std::size_t drawn = 0; drawn < frames; drawn += block) {
    std::size_t frame = (*draw)();
    const std::size_t length = std::min(block, frames - drawn);
    for (std::size_t i = 0; i < length; ++i) {
      ++weights[frame];
      frame = frame + 1 == frames ? 0 : frame + 1;
    }
  }
  return weights;
}

/// `values` not empty, in any order; left in another.
double percentile(std::vector<double>* values, double fraction) {
  const double position = fraction * static_cast<double>(values->size() - 1);
  const auto at = values->begin() + static_cast<std::ptrdiff_t>(std::floor(position));
  std::nth_element(values->begin(), at, values->end());
  const double below = *at;
  const double above = at + 1 == values->end() ? below : *std::min_element(at + 1, values->end());
  return below + (position - std::floor(position)) * (above - below);
}

}  // namespace

std::vector<ConfidenceInterval> blockBootstrap(std::size_t frames, const BootstrapOptions& options,
                                               const WeightedFigures& figures) {
  return blockBootstrapOfMany(
      frames, options, [&figures](const std::vector<std::vector<std::uint32_t>>& resamples) {
        std::vector<std::vector<double>> rows;
        rows.reserve(resamples.size());
        std::transform(resamples.begin(), resamples.end(), std::back_inserter(rows), figures);
        return rows;
      });
}

std::vector<ConfidenceInterval> blockBootstrapOfMany(std::size_t frames,
                                                     const BootstrapOptions& options,
                                                     const FiguresOfResamples& figures) {
  validate(frames, options);
  const std::size_t block = options.block_length > 0
                                ? static_cast<std::size_t>(options.block_length)
                                : automaticBlockLength(frames);
  FrameDraw draw(frames, options.seed);
  std::vector<std::vector<double>> samples;  // by figure
  for (int begin = 0; begin < options.resamples; begin += kResamplesAtOnce) {
    std::vector<std::vector<std::uint32_t>> resamples(
        static_cast<std::size_t>(std::min(kResamplesAtOnce, options.resamples - begin)));
    for (std::vector<std::uint32_t>& weights : resamples) {
      weights = drawWeights(frames, block, &draw);
    }
    for (const std::vector<double>& values : figures(resamples)) {
      samples.resize(values.size());
      for (std::size_t figure = 0; figure < values.size(); ++figure) {
        if (!std::isnan(values[figure])) {
          samples[figure].push_back(values[figure]);
        }
      }
    }
  }
  std::vector<ConfidenceInterval> intervals;
  intervals.reserve(samples.size());
  const double tail = (1 - options.level) / 2;
  for (std::vector<double>& values : samples) {
    ConfidenceInterval interval{options.level, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::quiet_NaN()};
    if (!values.empty()) {
      interval.low = percentile(&values, tail);
      interval.high = percentile(&values, 1 - tail);
    }
    intervals.push_back(interval);
  }
  return intervals;
}

}  // namespace evolin
