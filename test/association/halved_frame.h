// A frame as a camera of half the resolution has it.
#pragma once

#include <opencv2/imgproc.hpp>

#include "evolin_ros/association/line_associator.h"

namespace evolin::test {

/// `frame` has a camera and depth. Pixel centres are whole numbers.
inline FrameLines halved(FrameLines frame) {
  const auto half = [](double pixel) { return (pixel + 0.5) / 2 - 0.5; };
  const cv::Mat image = frame.frame.image;
  const cv::Mat depth = frame.frame.depth;
  frame.frame.image = cv::Mat();
  frame.frame.depth = cv::Mat();
  if (!image.empty()) cv::resize(image, frame.frame.image, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  cv::resize(depth, frame.frame.depth, cv::Size(), 0.5, 0.5, cv::INTER_NEAREST);
  Camera& camera = *frame.frame.camera;
  camera.width /= 2;
  camera.height /= 2;
  camera.fx /= 2;
  camera.fy /= 2;
  camera.cx = half(camera.cx);
  camera.cy = half(camera.cy);
  for (LineSegment& line : frame.lines) {
    line.x1 = half(line.x1);
    line.y1 = half(line.y1);
    line.x2 = half(line.x2);
    line.y2 = half(line.y2);
  }
  return frame;
}

}  // namespace evolin::test
