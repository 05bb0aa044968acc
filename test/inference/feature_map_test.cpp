// Local maxima, the best k, coordinates between grids and samples between pixels.
#include "evolin_ros/inference/feature_map.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

cv::Mat map(std::initializer_list<std::initializer_list<float>> rows) {
  cv::Mat result(static_cast<int>(rows.size()), static_cast<int>(rows.begin()->size()), CV_32FC1);
  int y = 0;
  for (const auto& row : rows) {
    std::copy(row.begin(), row.end(), result.ptr<float>(y++));
  }
  return result;
}

TEST(LocalMaxima, AreNoSmallerThanTheirNeighbours) {
  const std::vector<Peak> peaks =
      localMaxima(map({{1, 0, 0, 2}, {0, 0, 0, 0}, {5, 4, 0, 3}}), 3, 0);
  ASSERT_EQ(peaks.size(), 4U);
  EXPECT_EQ(peaks[0].x, 0);
  EXPECT_EQ(peaks[1].x, 3);
  EXPECT_EQ(peaks[2].y, 2);
  EXPECT_EQ(peaks[2].value, 5);
  EXPECT_EQ(peaks[3].value, 3);
}

TEST(LocalMaxima, TheWindowSaysHowFarNeighboursReach) {
  const cv::Mat row = map({{5, 0, 4, 0, 0, 3}});
  EXPECT_EQ(localMaxima(row, 1, 0).size(), 3U);
  EXPECT_EQ(localMaxima(row, 3, 0).size(), 3U);
  EXPECT_EQ(localMaxima(row, 5, 0).size(), 2U);
  EXPECT_EQ(localMaxima(row, 7, 0).size(), 1U);
}

TEST(LocalMaxima, EqualNeighboursAllStayAndTheThresholdIsStrict) {
  EXPECT_EQ(localMaxima(map({{2, 2}, {2, 2}}), 3, 1).size(), 4U);
  EXPECT_TRUE(localMaxima(map({{2, 2}, {2, 2}}), 3, 2).empty());
}

TEST(LocalMaxima, NotANumberIsNoPeakAndHidesNone) {
  const std::vector<Peak> peaks = localMaxima(map({{kNaN, 1, kNaN}}), 3, 0);
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_EQ(peaks[0].x, 1);
}

TEST(LocalMaxima, RefuseOtherMapsAndEvenWindows) {
  EXPECT_TRUE(localMaxima(cv::Mat(), 3, 0).empty());
  EXPECT_THROW(localMaxima(cv::Mat(2, 2, CV_8UC1), 3, 0), Error);
  EXPECT_THROW(localMaxima(map({{1}}), 2, 0), Error);
  EXPECT_THROW(localMaxima(map({{1}}), 0, 0), Error);
}

TEST(KeepBest, SortsByValueAndKeepsTheOrderOfEquals) {
  std::vector<Peak> peaks = {{0, 0, 1}, {1, 0, 3}, {2, 0, 1}, {3, 0, 2}};
  keepBest(3, &peaks);
  ASSERT_EQ(peaks.size(), 3U);
  EXPECT_EQ(peaks[0].x, 1);
  EXPECT_EQ(peaks[1].x, 3);
  EXPECT_EQ(peaks[2].x, 0);
  keepBest(10, &peaks);
  EXPECT_EQ(peaks.size(), 3U);
  keepBest(0, &peaks);
  EXPECT_TRUE(peaks.empty());
}

TEST(MapCoordinate, EdgesOrCentresCoincide) {
  EXPECT_DOUBLE_EQ(mapCoordinate(0, 4, 8, Alignment::kHalfPixel), 0.5);
  EXPECT_DOUBLE_EQ(mapCoordinate(3.5, 4, 8, Alignment::kHalfPixel), 7.5);
  EXPECT_DOUBLE_EQ(mapCoordinate(0, 4, 8, Alignment::kCorners), 0);
  EXPECT_DOUBLE_EQ(mapCoordinate(3, 4, 8, Alignment::kCorners), 7);
  EXPECT_DOUBLE_EQ(mapCoordinate(0, 1, 8, Alignment::kCorners), 0);
}

class Samples : public ::testing::Test {
 protected:
  Samples() {
    const std::array<int, 3> shape{2, 2, 3};
    maps_.create(3, shape.data(), CV_32F);
    for (int i = 0; i < 12; ++i) {
      maps_.ptr<float>()[i] = static_cast<float>(i * i);
    }
  }

  std::vector<float> at(double x, double y, Beyond beyond = Beyond::kNearest) const {
    std::vector<float> samples;
    sampleBilinear(maps_, x, y, beyond, &samples);
    return samples;
  }

  cv::Mat maps_;
};

TEST_F(Samples, AtPixelCentresAreTheValues) {
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      for (const Beyond beyond : {Beyond::kNearest, Beyond::kZero}) {
        const std::vector<float> samples = at(x, y, beyond);
        ASSERT_EQ(samples.size(), 2U);
        EXPECT_EQ(samples[0], maps_.at<float>(0, y, x));
        EXPECT_EQ(samples[1], maps_.at<float>(1, y, x));
      }
    }
  }
}

TEST_F(Samples, BetweenThemAreWeighted) {
  EXPECT_FLOAT_EQ(at(0.25, 0.5)[0],
                  0.5F * (0.75F * 0 + 0.25F * 1) + 0.5F * (0.75F * 9 + 0.25F * 16));
}

TEST_F(Samples, BeyondAreTheNearestOrFadeToZero) {
  EXPECT_FLOAT_EQ(at(5, 0)[0], 4);
  EXPECT_FLOAT_EQ(at(2.5, 0, Beyond::kZero)[0], 2);
  EXPECT_FLOAT_EQ(at(-0.5, 1, Beyond::kZero)[1], 40.5F);
  EXPECT_FLOAT_EQ(at(3, 0, Beyond::kZero)[0], 0);
  EXPECT_FLOAT_EQ(at(-1e30, 0, Beyond::kZero)[0], 0);
}

TEST_F(Samples, CoordinatesThatAreNotFiniteGiveZeros) {
  for (const double odd : {static_cast<double>(kNaN), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(at(odd, 0), std::vector<float>(2, 0));
    EXPECT_EQ(at(0, odd, Beyond::kZero), std::vector<float>(2, 0));
  }
  std::vector<float> samples;
  EXPECT_THROW(sampleBilinear(cv::Mat(2, 2, CV_32F), 0, 0, Beyond::kZero, &samples), Error);
}

}  // namespace
}  // namespace evolin
