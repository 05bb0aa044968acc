// Lines on copies of images.
#include "evolin_ros/drawing/overlay.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/drawing/canvas.h"
#include "evolin_ros/drawing/palette.h"

namespace evolin {

namespace {

constexpr Colour kGreen{0, 220, 0};

cv::Mat colourCopy(const cv::Mat& image) {
  cv::Mat colour;
  if (image.channels() == 1) {
    cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
  } else {
    colour = image.clone();
  }
  return colour;
}

}  // namespace

cv::Mat drawLines(const cv::Mat& image, const LineSegments& lines, const LineStyle& style) {
  cv::Mat picture = colourCopy(image);
  Canvas canvas(picture, 1);
  for (const LineSegment& line : lines) {
    canvas.drawLine(line, {kGreen, static_cast<double>(style.width)});
    if (style.endpoints) {
      canvas.drawDot({line.x1, line.y1}, style.width + 1, kGreen);
      canvas.drawDot({line.x2, line.y2}, style.width + 1, kGreen);
    }
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
  colourCopy(first_image).copyTo(left);
  colourCopy(second_image).copyTo(right);
  Canvas left_canvas(left, 1);
  Canvas right_canvas(right, 1);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].first < first_lines.size() && matches[i].second < second_lines.size()) {
      const Pen pen{colourOfNumber(static_cast<std::int64_t>(i))};
      left_canvas.drawLine(first_lines[matches[i].first], pen);
      right_canvas.drawLine(second_lines[matches[i].second], pen);
    }
  }
  return picture;
}

}  // namespace evolin
