// Pictures of lines: where they are drawn and what is left out.
#include "evolin_ros/drawing/overlay.h"

#include <gtest/gtest.h>

#include <limits>

namespace evolin {
namespace {

LineSegment line(double x1, double y1, double x2, double y2) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  return result;
}

/// Green well above what stood there: anti-aliasing leaves no exact colour.
bool isGreen(const cv::Vec3b& pixel) {
  return pixel[1] > pixel[0] + 80 && pixel[1] > pixel[2] + 80;
}

bool near(const cv::Vec3b& a, const cv::Vec3b& b) { return cv::norm(a, b, cv::NORM_INF) <= 30; }

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(DrawLines, DrawsOnACopyInColour) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image(40, 60, type, cv::Scalar::all(50));
    const cv::Mat picture = drawLines(image, {line(10, 20, 50, 20)});
    ASSERT_EQ(picture.type(), CV_8UC3);
    ASSERT_EQ(picture.size(), image.size());
    EXPECT_TRUE(isGreen(picture.at<cv::Vec3b>(20, 30)));
    EXPECT_EQ(picture.at<cv::Vec3b>(30, 30), cv::Vec3b(50, 50, 50));
    EXPECT_EQ(cv::norm(image, cv::Mat(40, 60, type, cv::Scalar::all(50)), cv::NORM_INF), 0);
  }
}

TEST(DrawLines, LeavesOutWhatIsNotFiniteAndCutsWhatLeavesTheImage) {
  const cv::Mat image(40, 60, CV_8UC1, cv::Scalar::all(50));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const cv::Mat untouched = drawLines(image, {});
  for (const LineSegment& odd :
       {line(nan, 1, 2, 3), line(0, 0, infinity, 20), line(0, -infinity, 5, 5), line(70, 0, 70, 40),
        line(-1e300, 0, 1e300, 20)}) {
    EXPECT_TRUE(same(drawLines(image, {odd}), untouched));
  }
  for (const double far : {70.0, 5000.0, 1e9}) {
    EXPECT_TRUE(isGreen(drawLines(image, {line(-far, 20, far, 20)}).at<cv::Vec3b>(20, 0))) << far;
  }
}

TEST(DrawMatches, SetsImagesSideBySideWithOneColourAPair) {
  const cv::Mat first(30, 40, CV_8UC1, cv::Scalar::all(10));
  const cv::Mat second(50, 60, CV_8UC3, cv::Scalar::all(20));
  const LineSegments first_lines = {line(5, 10, 35, 10), line(5, 20, 35, 20)};
  const LineSegments second_lines = {line(5, 40, 55, 40), line(5, 15, 55, 15)};
  const cv::Mat picture =
      drawMatches(first, first_lines, second, second_lines, {{0, 1}, {1, 0}, {7, 0}, {0, 7}});
  ASSERT_EQ(picture.size(), cv::Size(100, 50));
  ASSERT_EQ(picture.type(), CV_8UC3);
  const cv::Vec3b one = picture.at<cv::Vec3b>(10, 20);
  const cv::Vec3b two = picture.at<cv::Vec3b>(20, 20);
  EXPECT_FALSE(near(one, two));
  EXPECT_FALSE(near(one, {10, 10, 10}));
  EXPECT_TRUE(near(picture.at<cv::Vec3b>(15, 40 + 30), one));
  EXPECT_TRUE(near(picture.at<cv::Vec3b>(40, 40 + 30), two));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(10, 10, 10));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 42), cv::Vec3b(20, 20, 20));
  EXPECT_EQ(picture.at<cv::Vec3b>(45, 5), cv::Vec3b(0, 0, 0)) << "below the smaller image";
}

TEST(DrawMatches, WithoutMatchesShowsTheImages) {
  const cv::Mat image(8, 8, CV_8UC1, cv::Scalar::all(10));
  const cv::Mat picture = drawMatches(image, {line(1, 1, 6, 6)}, image, {}, {});
  EXPECT_TRUE(same(picture, cv::Mat(8, 16, CV_8UC3, cv::Scalar::all(10))));
}

}  // namespace
}  // namespace evolin
