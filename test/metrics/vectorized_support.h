// What the tests of the vectorized metric share: short ways to write lines and expectations.
#pragma once

#include <gtest/gtest.h>

#include "evolin_ros/metrics/vectorized.h"

namespace evolin::test {

// One pixel of the image is one pixel of the scaled image.
constexpr ImageSize kUnit{128, 128};
constexpr std::size_t kOrthogonal5 = 0;
constexpr std::size_t kStructural5 = 3;
constexpr std::size_t kSettings = 6;

inline LineSegment segment(double x1, double y1, double x2, double y2, double score = kNoScore) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  line.score = score;
  return line;
}

inline VectorizedOptions optionsOf(Protocol protocol) {
  VectorizedOptions options;
  options.protocol = protocol;
  return options;
}

inline void expectCounts(const Classification& counts, std::uint64_t true_positives,
                         std::uint64_t predicted, std::uint64_t ground_truth) {
  EXPECT_EQ(counts.true_positives, true_positives);
  EXPECT_EQ(counts.predicted, predicted);
  EXPECT_EQ(counts.ground_truth, ground_truth);
}

inline void expectEqual(const Classification& a, const Classification& b) {
  expectCounts(a, b.true_positives, b.predicted, b.ground_truth);
}

/// Counts of one unscored frame under one setting.
inline Classification countsOf(const LineSegments& predicted, const LineSegments& truth,
                               Protocol protocol, std::size_t setting, ImageSize size = kUnit) {
  VectorizedMetrics metrics(optionsOf(protocol));
  metrics.addFrame(0, "0000", size, predicted, truth, false);
  return metrics.classification(setting);
}

}  // namespace evolin::test
