// Images that have made detectors crash, and what every detector owes them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/line_detector.h"
#include "test/support/fuzz_images.h"

namespace evolin::test {

/// Corners of the bright quadrilateral in quadrilateralImage(), in order.
inline std::vector<cv::Point> corners() { return {{80, 40}, {260, 70}, {236, 205}, {56, 175}}; }

/// Dark, with a bright quadrilateral whose sides every method finds.
inline cv::Mat quadrilateralImage() {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(40));
  cv::fillConvexPoly(image, corners(), cv::Scalar(200), cv::LINE_AA);
  return image;
}

/// Finite lines, a score exactly where scores are promised.
inline void expectSound(const LineSegments& lines, const LineDetector& detector,
                        const std::string& what) {
  for (const LineSegment& line : lines) {
    ASSERT_TRUE(line.isFinite()) << what;
    ASSERT_EQ(line.hasScore(), detector.givesScores()) << what;
  }
}

/// Runs a configured detector over noise, flat and step images of all awkward sizes, grey and BGR,
/// then over a window into a larger image.
inline void expectSurvivesAwkwardImages(LineDetector* detector) {
  for (const cv::Size& size : awkwardSizes()) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const std::string what = std::to_string(size.width) + "x" + std::to_string(size.height);
      Frame frame;
      frame.name = what;
      frame.image = uniformNoise(size, type);
      LineSegments lines;
      ASSERT_NO_THROW(lines = detector->detect(frame)) << what;
      expectSound(lines, *detector, what);

      frame.image = cv::Mat(size, type, cv::Scalar::all(128));
      ASSERT_NO_THROW(lines = detector->detect(frame)) << what;
      EXPECT_TRUE(lines.empty()) << lines.size() << " lines in a flat image of " << what;

      frame.image.colRange(size.width / 2, size.width).setTo(cv::Scalar::all(255));
      ASSERT_NO_THROW(lines = detector->detect(frame)) << what;
      expectSound(lines, *detector, what);
    }
  }
  const cv::Mat whole = uniformNoise({400, 300}, CV_8UC1);
  Frame window;
  window.image = whole(cv::Rect(17, 23, 133, 151));
  Frame copy;
  copy.image = window.image.clone();
  const LineSegments lines = detector->detect(window);
  const LineSegments copied = detector->detect(copy);
  ASSERT_EQ(lines.size(), copied.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].x1, copied[i].x1);
    EXPECT_EQ(lines[i].y2, copied[i].y2);
  }
}

inline double distanceToLine(double x, double y, cv::Point a, cv::Point b) {
  const cv::Point along = b - a;
  return std::abs(along.x * (y - a.y) - along.y * (x - a.x)) / std::hypot(along.x, along.y);
}

/// For each side of the quadrilateral there is a line along it that is at least half as long.
inline void expectFindsQuadrilateral(LineDetector* detector) {
  Frame frame;
  frame.image = quadrilateralImage();
  const LineSegments lines = detector->detect(frame);
  for (std::size_t side = 0; side < 4; ++side) {
    const cv::Point a = corners()[side];
    const cv::Point b = corners()[(side + 1) % 4];
    bool found = false;
    for (const LineSegment& line : lines) {
      found = found || (line.length() > 0.5 * std::hypot(b.x - a.x, b.y - a.y) &&
                        distanceToLine(line.x1, line.y1, a, b) < 2.5 &&
                        distanceToLine(line.x2, line.y2, a, b) < 2.5);
    }
    EXPECT_TRUE(found) << "side " << side << " among " << lines.size() << " lines";
  }
}

/// Another type and an empty image are errors, not crashes.
inline void expectRefusesOtherImages(LineDetector* detector) {
  Frame frame;
  EXPECT_THROW(detector->detect(frame), Error);
  frame.image = cv::Mat(20, 20, CV_16UC1, cv::Scalar(7));
  EXPECT_THROW(detector->detect(frame), Error);
}

}  // namespace evolin::test
