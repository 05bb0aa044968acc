// Golden figures of the shared samples, and comparison against them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/frame.h"
#include "test/support/shared_data.h"

namespace evolin::test {

/// The frames that have golden detections: number of the living-room sample's image.
constexpr int kGoldenFrames = 6;

inline std::filesystem::path goldenFolder() {
  return sharedFolder() / "data" / "golden" / "classical";
}

/// "0003"
inline std::string frameNumber(int index) {
  const std::string digits = std::to_string(index);
  return std::string(4 - digits.size(), '0') + digits;
}

/// "icl_0003"
inline std::string goldenStem(int index) { return "icl_" + frameNumber(index); }

inline Frame readGoldenFrame(const std::filesystem::path& file) {
  Frame frame;
  frame.name = file.stem().string();
  frame.image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (frame.image.empty()) {
    ADD_FAILURE() << "cannot read " << file;
  }
  return frame;
}

/// The exact grey input of the golden detections.
inline Frame goldenGray(int index) {
  return readGoldenFrame(goldenFolder() / "gray" / (goldenStem(index) + ".png"));
}

/// The colour image that it was made from.
inline Frame goldenColor(int index) {
  return readGoldenFrame(sharedFolder() / "data" / "icl_nuim_lr_sample" / "rgb" /
                         (frameNumber(index) + ".png"));
}

/// A CSV of numbers with equally long rows.
inline std::vector<std::vector<double>> readTable(const std::filesystem::path& file) {
  std::vector<std::vector<double>> rows;
  for (const std::string& text : readLines(file)) {
    std::vector<double> row;
    for (const std::string_view cell : split(text, ',')) {
      row.push_back(parseDouble(cell).value());
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Same count, same order, every coordinate within `tolerance` pixels.
inline ::testing::AssertionResult linesNear(const LineSegments& lines, const LineSegments& golden,
                                            double tolerance) {
  if (lines.size() != golden.size()) {
    return ::testing::AssertionFailure() << lines.size() << " lines, golden has " << golden.size();
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineSegment& a = lines[i];
    const LineSegment& b = golden[i];
    const double worst = std::fmax(std::fmax(std::abs(a.x1 - b.x1), std::abs(a.y1 - b.y1)),
                                   std::fmax(std::abs(a.x2 - b.x2), std::abs(a.y2 - b.y2)));
    if (!(worst <= tolerance)) {
      return ::testing::AssertionFailure()
             << "line " << i << " (" << a.x1 << ", " << a.y1 << ", " << a.x2 << ", " << a.y2
             << ") is " << worst << " px from golden (" << b.x1 << ", " << b.y1 << ", " << b.x2
             << ", " << b.y2 << ")";
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace evolin::test
