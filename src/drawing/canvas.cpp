// OpenCV's fixed-point drawing behind coordinates of the unscaled image.
#include "evolin_ros/drawing/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "evolin_ros/geometry/clipping.h"

namespace evolin {

namespace {

constexpr int kFractionBits = 4;
constexpr double kDash = 6;  // pixels of the unscaled image
constexpr double kGap = 4;
constexpr double kFarthest = 1e9;  // cutting at the border loses digits with the distance
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21;  // of the font at scale 1

}  // namespace

cv::Scalar toBgr(const Colour& colour) {
  return {static_cast<double>(colour.blue), static_cast<double>(colour.green),
          static_cast<double>(colour.red)};
}

Canvas::Canvas(const cv::Mat& picture, double scale) : picture_(picture), scale_(scale) {}

cv::Point Canvas::fixed(const cv::Point2d& point) const {
  // The unscaled pixel (0, 0) covers the first `scale` pixels of the picture, its centre theirs.
  const auto place = [this](double value) {
    return cvRound(((value + 0.5) * scale_ - 0.5) * (1 << kFractionBits));
  };
  return {place(point.x), place(point.y)};
}

int Canvas::thickness(double width) const { return std::max(1, cvRound(width * scale_)); }

void Canvas::drawPiece(const cv::Point2d& from, const cv::Point2d& to, const Pen& pen) {
  cv::line(picture_, fixed(from), fixed(to), toBgr(pen.colour), thickness(pen.width), cv::LINE_AA,
           kFractionBits);
}

void Canvas::drawLine(const LineSegment& line, const Pen& pen) {
  // Fixed-point numbers would overflow far outside, and dashes would be without number.
  const double beyond = 2 + pen.width;
  const double farthest =
      std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
  const std::optional<LineSegment> visible = clipToRectangle(
      line, {-beyond, -beyond, picture_.cols / scale_ + beyond, picture_.rows / scale_ + beyond});
  if (!visible || farthest > kFarthest) {
    return;
  }
  const cv::Point2d from(visible->x1, visible->y1);
  const cv::Point2d to(visible->x2, visible->y2);
  const double length = visible->length();
  if (!pen.dashed || length <= kDash) {
    drawPiece(from, to, pen);
    return;
  }
  // A whole number of periods and a dash at either end.
  const double periods = std::max(1.0, std::round((length - kDash) / (kDash + kGap)));
  const double period = (length - kDash) / periods;
  for (int i = 0; i <= static_cast<int>(periods); ++i) {
    const double begin = i * period / length;
    drawPiece(from + begin * (to - from), from + (begin + kDash / length) * (to - from), pen);
  }
}

void Canvas::drawPath(const std::vector<cv::Point2d>& points, const Pen& pen) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    LineSegment piece;
    piece.x1 = points[i - 1].x;
    piece.y1 = points[i - 1].y;
    piece.x2 = points[i].x;
    piece.y2 = points[i].y;
    drawLine(piece, pen);
  }
}

void Canvas::drawDot(const cv::Point2d& centre, double radius, const Colour& colour) {
  const bool inside = centre.x >= -radius && centre.x <= picture_.cols / scale_ + radius &&
                      centre.y >= -radius && centre.y <= picture_.rows / scale_ + radius;
  if (inside) {  // false for NaN, too
    const int fixed_radius =
        std::max(1 << kFractionBits, cvRound(radius * scale_ * (1 << kFractionBits)));
    cv::circle(picture_, fixed(centre), fixed_radius, toBgr(colour), cv::FILLED, cv::LINE_AA,
               kFractionBits);
  }
}

void Canvas::drawText(const std::string& text, const cv::Point2d& corner, double height,
                      const Colour& colour) {
  const cv::Point place(cvRound((corner.x + 0.5) * scale_ - 0.5),
                        cvRound((corner.y + 0.5) * scale_ - 0.5));
  cv::putText(picture_, text, place, kFont, height * scale_ / kCapitalHeight, toBgr(colour),
              thickness(height / 14), cv::LINE_AA);
}

double Canvas::textWidth(const std::string& text, double height) {
  return cv::getTextSize(text, kFont, 1, 1, nullptr).width * height / kCapitalHeight;
}

}  // namespace evolin
