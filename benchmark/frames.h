// The frames that benchmarks run on: the real samples where EVOLIN_SHARED names them, else a drawn
// image.
#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "benchmark/real_input.h"
#include "evolin_ros/dataset/frame.h"

namespace evolin::benchmark_frames {

/// 640x480 grey, 60 polygons of random shade, blurred and with some noise; the same in every run.
inline cv::Mat drawnImage(int shift) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(110));
  cv::RNG random(5);
  for (int i = 0; i < 60; ++i) {
    std::vector<cv::Point> corners;
    const cv::Point centre(random.uniform(0, 640) + shift, random.uniform(0, 480));
    for (int k = 0; k < 4; ++k) {
      corners.emplace_back(centre.x + random.uniform(-80, 80), centre.y + random.uniform(-80, 80));
    }
    cv::fillConvexPoly(image, corners, cv::Scalar(random.uniform(0, 256)));
  }
  cv::GaussianBlur(image, image, cv::Size(3, 3), 0.8);
  cv::Mat noise(image.size(), CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 6);
  return image + noise;
}

/// Six frames, grey.
inline std::vector<Frame> load() {
  std::vector<Frame> frames;
  const std::filesystem::path folder = benchmark_input::realInput("data/icl_nuim_lr_sample/rgb");
  for (int i = 0; i < 6; ++i) {
    Frame frame;
    frame.name = "000" + std::to_string(i);
    frame.image = folder.empty()
                      ? drawnImage(2 * i)
                      : cv::imread((folder / (frame.name + ".png")).string(), cv::IMREAD_GRAYSCALE);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace evolin::benchmark_frames
