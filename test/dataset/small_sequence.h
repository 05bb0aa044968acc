// Small sequences that reader tests make for themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "evolin_ros/dataset/sequence_reader.h"

namespace evolin::test {

/// Writes an 8 x 6 colour image whose every byte is `value`.
inline void writeImage(const std::filesystem::path& file, int value = 100,
                       cv::Size size = cv::Size(8, 6)) {
  std::filesystem::create_directories(file.parent_path());
  cv::imwrite(file.string(), cv::Mat(size, CV_8UC3, cv::Scalar::all(value)));
}

/// Writes a 16-bit depth image with `value` everywhere.
inline void writeDepth(const std::filesystem::path& file, int value = 5000,
                       cv::Size size = cv::Size(8, 6)) {
  std::filesystem::create_directories(file.parent_path());
  cv::imwrite(file.string(), cv::Mat(size, CV_16UC1, cv::Scalar::all(value)));
}

inline std::vector<SequenceFrame> readAll(SequenceReader* reader) {
  std::vector<SequenceFrame> frames;
  while (std::optional<SequenceFrame> frame = reader->next()) {
    frames.push_back(std::move(*frame));
  }
  return frames;
}

inline std::vector<SequenceFrame> readAll(const std::filesystem::path& folder,
                                          const SequenceOptions& options = {}) {
  return readAll(openSequence(folder, options).get());
}

inline std::filesystem::path cameraFolder() {
  return std::filesystem::path(__FILE__).parent_path() / "../../config/cameras";
}

}  // namespace evolin::test
