// Lines, dots and text on a picture, given in the pixels of an image that the picture shows larger
// or smaller.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evolin_ros/drawing/palette.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Widths in pixels of the unscaled image.
struct Pen {
  Colour colour;
  double width = 1;
  bool dashed = false;
};

/// For pictures of OpenCV.
cv::Scalar toBgr(const Colour& colour);

/// Draws into a picture of somebody else's, CV_8UC3, anti-aliased, to a sixteenth of a pixel.
/// Coordinates are those of the unscaled image, the centre of the top-left pixel at (0, 0); what
/// leaves the picture is cut, and what is not finite, or farther away than 1e9, is left out.
/// Nothing is ever thinner than one pixel of the picture.
class Canvas {
 public:
  Canvas(const cv::Mat& picture, double scale);

  void drawLine(const LineSegment& line, const Pen& pen);
  void drawPath(const std::vector<cv::Point2d>& points, const Pen& pen);
  void drawDot(const cv::Point2d& centre, double radius, const Colour& colour);

  /// `corner` is the lower left one of the first letter; `height` that of a capital letter.
  void drawText(const std::string& text, const cv::Point2d& corner, double height,
                const Colour& colour);

  /// Of drawText().
  static double textWidth(const std::string& text, double height);

 private:
  void drawPiece(const cv::Point2d& from, const cv::Point2d& to, const Pen& pen);
  cv::Point fixed(const cv::Point2d& point) const;
  int thickness(double width) const;

  cv::Mat picture_;
  double scale_;
};

}  // namespace evolin
