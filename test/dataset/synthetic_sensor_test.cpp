// Blur and noise of the synthetic camera.
#include <gtest/gtest.h>

#include <cmath>

#include "sensor.h"

namespace evolin::synthetic {
namespace {

TEST(SyntheticSensor, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(normalQuantile(0.5), 0, 1e-12);
  EXPECT_NEAR(normalQuantile(0.975), 1.959963985, 1e-8);
  EXPECT_NEAR(normalQuantile(0.025), -1.959963985, 1e-8);
  EXPECT_NEAR(normalQuantile(0.841344746), 1, 1e-8);
  EXPECT_NEAR(normalQuantile(1e-5), -4.264890794, 1e-8);
  EXPECT_NEAR(normalQuantile(1 - 1e-5), 4.264890794, 1e-8);
}

TEST(SyntheticSensor, NoiseIsNormal) {
  const cv::Mat grey(300, 400, CV_32FC3, cv::Scalar::all(128));
  const cv::Mat noisy = digitise(grey, 5, 3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(noisy, mean, deviation);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(mean[channel], 128, 0.06);
    EXPECT_NEAR(deviation[channel], 5, 0.05);
  }
  std::size_t beyond =
      0;  // two standard deviations: 4.55 %; rounding puts the bound at 10.5 levels
  const auto* bytes = noisy.ptr<std::uint8_t>();
  for (std::size_t i = 0; i < noisy.total() * 3; ++i) {
    beyond += std::abs(bytes[i] - 128) > 10 ? 1 : 0;
  }
  const double share = static_cast<double>(beyond) / static_cast<double>(noisy.total() * 3);
  EXPECT_NEAR(share, std::erfc(10.5 / 5 / std::sqrt(2.0)), 0.002);
}

TEST(SyntheticSensor, NeighboursAndKeysAreIndependent) {
  const cv::Mat grey(300, 400, CV_32FC3, cv::Scalar::all(128));
  const cv::Mat a = digitise(grey, 8, 1);
  const cv::Mat b = digitise(grey, 8, 2);
  double across = 0;
  double along = 0;
  const auto* x = a.ptr<std::uint8_t>();
  const auto* y = b.ptr<std::uint8_t>();
  const std::size_t count = a.total() * 3 - 1;
  for (std::size_t i = 0; i < count; ++i) {
    across += (x[i] - 128.0) * (y[i] - 128.0) / 64;
    along += (x[i] - 128.0) * (x[i + 1] - 128.0) / 64;
  }
  EXPECT_NEAR(across / static_cast<double>(count), 0, 0.01);
  EXPECT_NEAR(along / static_cast<double>(count), 0, 0.01);
}

TEST(SyntheticSensor, RoundsAndClampsWithoutNoise) {
  cv::Mat image(1, 3, CV_32FC3, cv::Scalar(-4, 12.49, 300));
  image.at<cv::Vec3f>(0, 1) = cv::Vec3f(0.5F, 254.4F, 254.6F);
  const cv::Mat bytes = digitise(image, 0, 1);
  EXPECT_EQ(bytes.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 12, 255));
  EXPECT_EQ(bytes.at<cv::Vec3b>(0, 1), cv::Vec3b(1, 254, 255));
}

TEST(SyntheticSensor, BlurSpreadsAPointIntoAGaussian) {
  constexpr double kSigma = 1.7;
  cv::Mat image(41, 41, CV_32FC3, cv::Scalar::all(0));
  image.at<cv::Vec3f>(20, 20) = cv::Vec3f(100, 100, 100);
  blur(kSigma, &image);
  double sum = 0;
  double square = 0;
  for (int row = 0; row < 41; ++row) {
    for (int column = 0; column < 41; ++column) {
      const float value = image.at<cv::Vec3f>(row, column)[1];
      sum += value;
      square += value * (column - 20.0) * (column - 20.0);
    }
  }
  EXPECT_NEAR(sum, 100, 1e-3);
  EXPECT_NEAR(square / sum, kSigma * kSigma, 0.01);
}

TEST(SyntheticSensor, BlurKeepsEvenAreasUpToTheRim) {
  cv::Mat image(8, 9, CV_32FC3, cv::Scalar(10, 20, 30));
  blur(3, &image);
  EXPECT_NEAR(image.at<cv::Vec3f>(0, 0)[0], 10, 1e-4);
  EXPECT_NEAR(image.at<cv::Vec3f>(7, 8)[2], 30, 1e-4);
}

}  // namespace
}  // namespace evolin::synthetic
