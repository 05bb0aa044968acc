// Where lines, dots and text land on a picture of another scale than the image.
#include "evolin_ros/drawing/canvas.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

namespace evolin {
namespace {

constexpr Colour kRed{255, 0, 0};

LineSegment line(double x1, double y1, double x2, double y2) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  return result;
}

cv::Mat black(int width, int height) { return {height, width, CV_8UC3, cv::Scalar::all(0)}; }

int red(const cv::Mat& picture, int x, int y) { return picture.at<cv::Vec3b>(y, x)[2]; }

/// Red of a column, weighted by the row: where a level line lies, to fractions of a pixel.
double centreOfColumn(const cv::Mat& picture, int x) {
  double sum = 0;
  double weighted = 0;
  for (int y = 0; y < picture.rows; ++y) {
    sum += red(picture, x, y);
    weighted += static_cast<double>(y) * red(picture, x, y);
  }
  return sum > 0 ? weighted / sum : -1;
}

TEST(Canvas, PixelsOfTheImageAreBlocksOfThePicture) {
  for (const int scale : {1, 2, 3, 4}) {
    const cv::Mat picture = black(40 * scale, 30 * scale);
    Canvas(picture, scale).drawLine(line(4, 10, 35, 10), {kRed});
    // The centre of image row 10 is the middle of the rows that show it.
    EXPECT_NEAR(centreOfColumn(picture, 20 * scale), 10.0 * scale + (scale - 1) / 2.0, 0.51)
        << scale;
    EXPECT_EQ(red(picture, 20 * scale, 15 * scale), 0) << scale;
  }
}

TEST(Canvas, DrawsBetweenPixels) {
  for (const double y : {10.0, 10.25, 10.5, 10.75}) {
    const cv::Mat picture = black(40, 30);
    Canvas(picture, 1).drawLine(line(4, y, 35, y), {kRed});
    EXPECT_NEAR(centreOfColumn(picture, 20), y, 0.13) << y;
  }
}

TEST(Canvas, WidthIsOfTheImageAndNeverBelowOnePixel) {
  const auto thickness = [](double scale, double width) {
    const cv::Mat picture = black(160, 120);
    Canvas(picture, scale).drawLine(line(0, 15, 40, 15), {kRed, width});
    int sum = 0;
    for (int y = 0; y < picture.rows; ++y) {
      sum += red(picture, 80, y);
    }
    return sum / 255.0;
  };
  // OpenCV smooths an edge over about a pixel.
  EXPECT_NEAR(thickness(4, 2), 8, 2.1);
  EXPECT_NEAR(thickness(2, 2), 4, 2.1);
  EXPECT_GE(thickness(2, 0.1), 0.8);
}

TEST(Canvas, DashesHaveGapsAndBothEnds) {
  const cv::Mat picture = black(120, 20);
  Canvas(picture, 1).drawLine(line(10, 10, 110, 10), {kRed, 1, true});
  int gaps = 0;
  for (int x = 11; x < 110; ++x) {
    gaps += red(picture, x, 10) < 30 && red(picture, x - 1, 10) >= 30 ? 1 : 0;
  }
  EXPECT_GE(gaps, 7);
  EXPECT_LE(gaps, 12);
  EXPECT_GT(red(picture, 11, 10), 150);
  EXPECT_GT(red(picture, 109, 10), 150);
}

TEST(Canvas, CutsWhatLeavesThePicture) {
  const cv::Mat whole = black(60, 40);
  cv::Mat part = whole(cv::Rect(0, 0, 30, 40));
  Canvas canvas(part, 1);
  canvas.drawLine(line(-1e9, 20, 1e9, 20), {kRed, 1, true});
  canvas.drawLine(line(5, 30, 55, 30), {kRed});
  canvas.drawDot({30, 10}, 5, kRed);
  EXPECT_GT(red(whole, 20, 30), 200);
  EXPECT_GT(red(whole, 28, 10), 200);
  EXPECT_EQ(cv::countNonZero(whole(cv::Rect(30, 0, 30, 40)).clone().reshape(1)), 0);
}

TEST(Canvas, LeavesOutWhatIsNotFinite) {
  const cv::Mat picture = black(60, 40);
  Canvas canvas(picture, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  canvas.drawLine(line(nan, 1, 2, 3), {kRed});
  canvas.drawLine(line(1, 1, 2, infinity), {kRed, 1, true});
  canvas.drawPath({{1, 1}, {nan, 5}, {3, 3}}, {kRed});
  canvas.drawDot({nan, 5}, 3, kRed);
  canvas.drawDot({infinity, 5}, 3, kRed);
  EXPECT_EQ(cv::countNonZero(picture.reshape(1)), 0);
}

TEST(Canvas, PathsJoinTheirPoints) {
  const cv::Mat picture = black(60, 40);
  Canvas(picture, 1).drawPath({{10, 10}, {40, 10}, {40, 30}}, {kRed});
  EXPECT_GT(red(picture, 25, 10), 200);
  EXPECT_GT(red(picture, 40, 20), 200);
  EXPECT_EQ(red(picture, 25, 20), 0);
}

TEST(Canvas, TextStandsOnItsCornerAndIsAsWideAsSaid) {
  for (const double scale : {1.0, 2.0}) {
    const cv::Mat picture = black(200 * static_cast<int>(scale), 60 * static_cast<int>(scale));
    Canvas(picture, scale).drawText("HNM", {10, 40}, 12, kRed);
    cv::Mat grey;
    cv::extractChannel(picture, grey, 2);
    const cv::Rect box = cv::boundingRect(grey > 60);
    EXPECT_NEAR(box.height / scale, 12, 2.5) << scale;
    EXPECT_NEAR((box.y + box.height) / scale, 40, 2.5) << scale;
    EXPECT_NEAR(box.width / scale, Canvas::textWidth("HNM", 12), 5) << scale;
  }
}

}  // namespace
}  // namespace evolin
