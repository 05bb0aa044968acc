// Random segments for property tests and benchmarks, the same on every platform.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin::test {

class RandomLines {
 public:
  explicit RandomLines(std::uint64_t seed) : generator_(seed) {}

  /// Uniform in [low, high); the standard's distributions differ from library to library.
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11U) * 0x1.0p-53;
  }

  /// A whole number in [0, count).
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }

  /// Endpoints anywhere in [0, width) x [0, height).
  LineSegments anywhere(std::size_t count, double width, double height) {
    LineSegments lines(count);
    for (LineSegment& line : lines) {
      line.x1 = uniform(0, width);
      line.y1 = uniform(0, height);
      line.x2 = uniform(0, width);
      line.y2 = uniform(0, height);
    }
    return lines;
  }

  /// `count` lines, each one of `truth` with endpoints moved by up to `noise`, with scores in [0,
  /// 1) in steps of 1/64, so that some are equal.
  LineSegments detectionsOf(const LineSegments& truth, std::size_t count, double noise) {
    LineSegments lines;
    for (std::size_t i = 0; i < count; ++i) {
      LineSegment line = truth[index(truth.size())];
      line.x1 += uniform(-noise, noise);
      line.y1 += uniform(-noise, noise);
      line.x2 += uniform(-noise, noise);
      line.y2 += uniform(-noise, noise);
      line.score = static_cast<double>(index(64)) / 64;
      lines.push_back(line);
    }
    return lines;
  }

  template <typename Values>
  void shuffle(Values* values) {
    for (std::size_t last = values->size(); last > 1; --last) {
      std::swap((*values)[last - 1], (*values)[index(last)]);
    }
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace evolin::test
