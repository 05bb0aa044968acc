// A camera that goes to the right in front of a wall with three lines.
#pragma once

#include <cstddef>
#include <cstdint>

#include "evolin_ros/evaluation/motion_evaluation.h"
#include "test/evaluation/sample_frames.h"
#include "test/metrics/spatial_support.h"

namespace evolin::test {

constexpr Stamp kPeriod = kNanosecondsPerSecond / 10;
constexpr Stamp kMillisecond = 1000000;

inline Stamp stampOf(int frame) { return (frame + 1) * kPeriod; }

/// The camera goes to the right in front of a wall with three lines: its image moves by `pixels` a
/// frame.
inline LineSegments linesAt(int frame, double pixels = 1) {
  const double shift = pixels * frame;
  return {line(40 - shift, 20, 70 - shift, 40, 0.9, 1),
          line(50 - shift, 60, 90 - shift, 61, 0.8, 2),
          line(60 - shift, 80, 61 - shift, 110, 0.7, 3)};
}

inline StampedPose poseAt(int frame, double pixels = 1) {
  return {stampOf(frame), poseRight(pixels * frame)};
}

inline DepthMap wall() { return DepthMap(wallDepth()); }

inline MotionOptions shortSteps() {
  MotionOptions options;
  options.repeatabilities.frame_steps = {1};
  return options;
}

inline Camera wallWalkCamera() {
  Camera result = wallCamera();
  result.width = kWallSide;
  result.height = kWallSide;
  return result;
}

inline LineMatches same(std::size_t count) {
  LineMatches matches(count);
  for (std::size_t i = 0; i < count; ++i) {
    matches[i].first = static_cast<std::uint32_t>(i);
    matches[i].second = static_cast<std::uint32_t>(i);
  }
  return matches;
}

}  // namespace evolin::test
