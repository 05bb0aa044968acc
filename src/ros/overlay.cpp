// Drawing with OpenCV's anti-aliased lines at a sixteenth of a pixel.
#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evolin::ros_shell {

namespace {

constexpr int kFractionBits = 4;

cv::Mat toBgr(const cv::Mat& image) {
  cv::Mat colour;
  if (image.channels() == 1) {
    cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
  } else {
    colour = image.clone();
  }
  return colour;
}

void drawLine(const LineSegment& line, const cv::Scalar& colour, cv::Mat* picture,
              const LineStyle& style = {}) {
  // Far outside the picture fixed-point coordinates would overflow.
  constexpr double kFarthest = 1e6;
  const double farthest =
      std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
  if (!line.isFinite() || farthest > kFarthest) {
    return;
  }
  const auto fixed = [](double value) { return cvRound(value * (1 << kFractionBits)); };
  const cv::Point from(fixed(line.x1), fixed(line.y1));
  const cv::Point to(fixed(line.x2), fixed(line.y2));
  cv::line(*picture, from, to, colour, style.width, cv::LINE_AA, kFractionBits);
  if (style.endpoints) {
    const int radius = fixed(2 + style.width);
    for (const cv::Point& end : {from, to}) {
      cv::circle(*picture, end, radius, colour, 1, cv::LINE_AA, kFractionBits);
    }
  }
}

/// Neighbouring numbers get hues far apart (steps of the golden angle).
cv::Scalar colourOf(std::size_t number) {
  constexpr double kGoldenAngle = 137.50776405003785;
  constexpr double kHueScale = 0.5;  // OpenCV's 8-bit hue counts half degrees
  const double hue = std::fmod(static_cast<double>(number) * kGoldenAngle, 360.0) * kHueScale;
  cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(hue, 255, 255));
  cv::cvtColor(pixel, pixel, cv::COLOR_HSV2BGR);
  const auto& bgr = pixel.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(bgr[0]), static_cast<double>(bgr[1]), static_cast<double>(bgr[2])};
}

}  // namespace

cv::Mat drawLines(const cv::Mat& image, const LineSegments& lines, const LineStyle& style) {
  cv::Mat picture = toBgr(image);
  for (const LineSegment& line : lines) {
    drawLine(line, {0, 220, 0}, &picture, style);
  }
  return picture;
}

cv::Mat drawMatches(const cv::Mat& first_image, const LineSegments& first_lines,
                    const cv::Mat& second_image, const LineSegments& second_lines,
                    const LineMatches& matches) {
  cv::Mat picture(std::max(first_image.rows, second_image.rows),
                  first_image.cols + second_image.cols, CV_8UC3, cv::Scalar::all(0));
  cv::Mat left = picture(cv::Rect(0, 0, first_image.cols, first_image.rows));
  cv::Mat right = picture(cv::Rect(first_image.cols, 0, second_image.cols, second_image.rows));
  toBgr(first_image).copyTo(left);
  toBgr(second_image).copyTo(right);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].first < first_lines.size() && matches[i].second < second_lines.size()) {
      drawLine(first_lines[matches[i].first], colourOf(i), &left);
      drawLine(second_lines[matches[i].second], colourOf(i), &right);
    }
  }
  return picture;
}

}  // namespace evolin::ros_shell
