// LBD on images whose gradients are known, and against the golden descriptors.
#include "evolin_ros/association/lbd_descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/base/error.h"
#include "test/support/golden.h"

namespace evolin {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

// Grey grows by two levels a pixel to the right.
cv::Mat ramp() {
  cv::Mat image(120, 120, CV_8UC1);
  for (int x = 0; x < image.cols; ++x) {
    image.col(x).setTo(2 * x);
  }
  return image;
}

cv::Mat texture(int rows, int cols) {
  cv::Mat image(rows, cols, CV_8UC1);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, cv::Size(9, 9), 2.0);
  return image;
}

enum Component { kAlongPositive, kAlongNegative, kAcrossPositive, kAcrossNegative };

float mean(const cv::Mat& descriptors, int band, Component component, int line = 0) {
  return descriptors.at<float>(line, 8 * band + component);
}

TEST(LbdDescriptor, HasOneRowOfSeventyTwoALine) {
  const cv::Mat descriptors =
      describeLbd(ramp(), {segment(40, 60, 80, 60), segment(60, 40, 61, 80)});
  EXPECT_EQ(descriptors.rows, 2);
  EXPECT_EQ(descriptors.cols, kLbdSize);
  EXPECT_EQ(descriptors.type(), CV_32F);
  EXPECT_EQ(describeLbd(ramp(), {}).rows, 0);
}

// Along a ramp only the first of the four sums is there. Every row of a band then weighs as the
// two windows say, so the bands' shares can be computed directly.
TEST(LbdDescriptor, SplitsARampAsTheWindowsSay) {
  const cv::Mat descriptors = describeLbd(ramp(), {segment(40, 60, 80, 60)});
  double expected[9] = {};
  for (int h = 0; h < 63; ++h) {
    const double global = std::exp(-(h - 31.0) * (h - 31.0) / (2 * 31.0 * 31.0));
    for (int band = std::max(0, h / 7 - 1); band <= std::min(8, h / 7 + 1); ++band) {
      const double d = h - (7 * band + 3);  // from the band's middle row
      expected[band] += global * std::exp(-d * d / (2 * 7.0 * 7.0));
    }
  }
  for (int band = 0; band < 9; ++band) {
    expected[band] /= band == 0 || band == 8 ? 14 : 21;
  }
  for (int band = 0; band < 9; ++band) {
    EXPECT_NEAR(mean(descriptors, band, kAlongPositive) / mean(descriptors, 4, kAlongPositive),
                std::min(expected[band] / expected[4], 1.0), 1e-4)
        << "band " << band;
    EXPECT_EQ(mean(descriptors, band, kAlongNegative), 0.0F);
    EXPECT_NEAR(mean(descriptors, band, kAcrossPositive), 0.0F, 1e-6);
    EXPECT_NEAR(mean(descriptors, band, kAcrossNegative), 0.0F, 1e-6);
  }
}

TEST(LbdDescriptor, SeesTheGradientInTheLinesOwnFrame) {
  const cv::Mat descriptors =
      describeLbd(ramp(), {segment(40, 60, 80, 60), segment(80, 60, 40, 60),
                           segment(60, 40, 60, 80), segment(60, 80, 60, 40)});
  const Component expected[] = {kAlongPositive, kAlongNegative, kAcrossNegative, kAcrossPositive};
  for (int line = 0; line < 4; ++line) {
    for (const Component component :
         {kAlongPositive, kAlongNegative, kAcrossPositive, kAcrossNegative}) {
      EXPECT_EQ(mean(descriptors, 4, component, line) > 0.1F, component == expected[line])
          << "line " << line << " component " << component;
    }
  }
}

TEST(LbdDescriptor, HasUnitLengthAndNoElementFarAboveTheClip) {
  LineSegments lines;
  for (int i = 0; i < 20; ++i) {
    lines.push_back(segment(20.0 + 7 * i, 30, 180.0 - 5 * i, 170.0 - 3 * i));
  }
  const cv::Mat descriptors = describeLbd(texture(200, 200), lines);
  for (int i = 0; i < descriptors.rows; ++i) {
    EXPECT_NEAR(cv::norm(descriptors.row(i)), 1.0, 1e-4) << "line " << i;
    double low = 0;
    cv::minMaxLoc(descriptors.row(i), &low);
    EXPECT_GE(low, 0.0) << "line " << i;
  }
}

// The fast path for supports inside the image and the clamping one must not differ: the same line
// of the same picture, once far from the border and once with the border close.
TEST(LbdDescriptor, DoesNotDependOnHowFarTheBorderIs) {
  const cv::Mat large = texture(300, 300);
  const cv::Mat small = large(cv::Rect(60, 60, 180, 180)).clone();
  // Its support keeps three pixels from the small image's border, where blur and derivative see
  // no replicated pixels, but not the margin of the fast path on every side.
  for (double shift = 0; shift < 8; shift += 1) {
    const LineSegment line = segment(63.0 + 31 + 3 + shift / 8, 70, 63.0 + 31 + 3 + shift / 8, 230);
    const LineSegment moved = segment(line.x1 - 60, line.y1 - 60, line.x2 - 60, line.y2 - 60);
    const cv::Mat a = describeLbd(large, {line});
    const cv::Mat b = describeLbd(small, {moved});
    EXPECT_LT(cv::norm(a, b), 1e-3) << "shift " << shift;
  }
}

TEST(LbdDescriptor, DoesNotLookBeyondAWindowIntoALargerImage) {
  const cv::Mat window = texture(300, 300)(cv::Rect(100, 100, 70, 70));
  const LineSegments lines = {segment(2, 2, 60, 40), segment(30, 1, 33, 69)};
  EXPECT_EQ(cv::norm(describeLbd(window, lines), describeLbd(window.clone(), lines)), 0.0);
}

TEST(LbdDescriptor, IsZeroWithoutTextureOrLength) {
  const cv::Mat flat(100, 100, CV_8UC1, cv::Scalar(99));
  EXPECT_EQ(cv::norm(describeLbd(flat, {segment(40, 50, 60, 50)})), 0.0);
  EXPECT_EQ(cv::norm(describeLbd(texture(100, 100), {segment(40, 50, 40, 50)})), 0.0);
}

TEST(LbdDescriptor, IsNanForCoordinatesThatAreNoPlaceInAnImage) {
  const LineSegments lines = {segment(kNan, 5, 9, 9),       segment(5, kInfinity, 9, 9),
                              segment(5, 5, -kInfinity, 9), segment(5, 5, 9, 1e30),
                              segment(40000, 5, 9, 9),      segment(5, 5, 90, 60)};
  const cv::Mat descriptors = describeLbd(texture(100, 100), lines);
  for (int i = 0; i < 5; ++i) {
    for (int d = 0; d < kLbdSize; ++d) {
      EXPECT_TRUE(std::isnan(descriptors.at<float>(i, d))) << "line " << i;
    }
  }
  EXPECT_TRUE(cv::checkRange(descriptors.row(5)));
}

TEST(LbdDescriptor, SurvivesLinesOutsideAndTinyImages) {
  const LineSegments lines = {segment(-500, -500, -400, -450), segment(900, 20, 901, 2000),
                              segment(-30000, 0, 30000, 40),   segment(-0.4, -0.4, 0.4, 0.4),
                              segment(0, 0, 0, 1e-30),         segment(3, -20, 3, 500)};
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(1, 64), cv::Size(64, 1), cv::Size(2, 2),
                               cv::Size(7, 7), cv::Size(640, 480)}) {
    const cv::Mat descriptors = describeLbd(texture(size.height, size.width), lines);
    EXPECT_TRUE(cv::checkRange(descriptors)) << size.width << "x" << size.height;
  }
}

TEST(LbdDescriptor, RefusesOtherImages) {
  EXPECT_THROW(describeLbd(cv::Mat(), {segment(1, 1, 2, 2)}), Error);
  EXPECT_THROW(describeLbd(cv::Mat(9, 9, CV_8UC3, cv::Scalar(0)), {segment(1, 1, 2, 2)}), Error);
}

class LbdDescriptorGolden : public ::testing::TestWithParam<const char*> {};

// 99 % of the lines within 1e-2 and none far away; the figures are recorded beside the result.
TEST_P(LbdDescriptorGolden, IsNearOnNinetyNineOfAHundredLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path lbd = test::goldenFolder() / "lbd";
  std::vector<double> distances;
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    const std::string file = test::goldenStem(i) + ".csv";
    const LineSegments lines = readLinesCsv(lbd / "lines" / GetParam() / file);
    const cv::Mat descriptors = describeLbd(test::goldenGray(i).image, lines);
    const auto golden = test::readTable(lbd / "descriptors" / GetParam() / file);
    ASSERT_EQ(golden.size(), lines.size());
    for (std::size_t k = 0; k < golden.size(); ++k) {
      ASSERT_EQ(golden[k].size(), static_cast<std::size_t>(kLbdSize));
      double squares = 0;
      for (int d = 0; d < kLbdSize; ++d) {
        const double difference = descriptors.at<float>(static_cast<int>(k), d) - golden[k][d];
        squares += difference * difference;
      }
      distances.push_back(std::sqrt(squares));
    }
  }
  std::sort(distances.begin(), distances.end());
  const std::size_t allowed = distances.size() / 100;
  RecordProperty("lines", static_cast<int>(distances.size()));
  RecordProperty("median", std::to_string(distances[distances.size() / 2]));
  RecordProperty("largest", std::to_string(distances.back()));
  EXPECT_LE(distances[distances.size() - 1 - allowed], 1e-2);
  EXPECT_LE(distances.back(), 5e-2);
}

INSTANTIATE_TEST_SUITE_P(Lines, LbdDescriptorGolden, ::testing::Values("gt", "lsd"));

}  // namespace
}  // namespace evolin
