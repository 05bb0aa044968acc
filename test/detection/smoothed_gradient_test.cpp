// The fused smoothing and differentiation against OpenCV's separate filters.
#include "smoothed_gradient.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/imgproc.hpp>

#include "test/detection/awkward_images.h"

namespace evolin {
namespace {

TEST(GaussianWeights, AddUpTo256AndRiseToTheCentre) {
  for (int kernel = 1; kernel <= kMaxSmoothingKernel; kernel += 2) {
    const std::vector<int> weights = gaussianWeights(kernel, 0.2 + kernel / 6.0);
    ASSERT_EQ(weights.size(), static_cast<std::size_t>(kernel / 2 + 1));
    EXPECT_EQ(2 * std::accumulate(weights.begin(), weights.end() - 1, 0) + weights.back(), 256);
    EXPECT_TRUE(std::is_sorted(weights.begin(), weights.end()));
  }
}

TEST(GaussianWeights, RoundAsComputedByHand) {
  EXPECT_EQ(gaussianWeights(7, 1.0), (std::vector<int>{1, 14, 62, 102}));
  EXPECT_EQ(gaussianWeights(5, 1.0), (std::vector<int>{14, 62, 104}));
}

/// Exact weights instead of 256ths, then OpenCV's Sobel filter.
void expectEqualsOpenCv(const cv::Mat& image, int kernel, int threshold) {
  const std::vector<int> weights = gaussianWeights(kernel, 1.0);
  cv::Mat window(1, kernel, CV_64F);
  for (int i = 0; i < kernel; ++i) {
    window.at<double>(i) = weights[static_cast<std::size_t>(std::min(i, kernel - 1 - i))] / 256.0;
  }
  cv::Mat exact;
  cv::Mat smoothed;
  cv::Mat wide;
  image.convertTo(wide, CV_64F);
  cv::sepFilter2D(wide, exact, CV_64F, window, window, cv::Point(-1, -1), 0,
                  cv::BORDER_REFLECT_101);
  // Halves go up, as in the filter's whole numbers.
  cv::Mat rounded(image.size(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      rounded.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::floor(exact.at<double>(y, x) + 0.5));
    }
  }
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(rounded, dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
  cv::Sobel(rounded, dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);

  SmoothedGradient gradient(kernel, 1.0);
  GradientMaps maps;
  gradient.compute(image, threshold, &maps);
  ASSERT_EQ(maps.width, image.cols);
  ASSERT_EQ(maps.height, image.rows);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int gx = dx.at<std::int16_t>(y, x);
      const int gy = dy.at<std::int16_t>(y, x);
      const std::size_t i = maps.at(x, y);
      ASSERT_EQ(maps.derivatives[2 * i], gx) << x << " " << y << " " << image.size();
      ASSERT_EQ(maps.derivatives[2 * i + 1], gy) << x << " " << y << " " << image.size();
      const int sum = std::abs(gx) + std::abs(gy);
      const int expected =
          2 * (sum >= threshold ? sum : 0) + (std::abs(gx) >= std::abs(gy) ? 1 : 0);
      ASSERT_EQ(maps.strength[i], expected) << x << " " << y << " " << image.size();
    }
  }
}

TEST(SmoothedGradient, EqualsOpenCvsFilters) {
  for (const cv::Size& size : test::awkwardSizes()) {
    for (const int kernel : {1, 3, 5, 7, 15}) {
      // OpenCV's filter does not mirror more than once.
      if (std::min(size.width, size.height) > kernel / 2 || kernel == 1) {
        expectEqualsOpenCv(test::uniformNoise(size, CV_8UC1), kernel, 30);
      }
    }
  }
}

TEST(SmoothedGradient, EqualsOpenCvsFiltersOnWindowsIntoImages) {
  const cv::Mat whole = test::uniformNoise({120, 90}, CV_8UC1);
  cv::Mat window = whole(cv::Rect(7, 11, 61, 43));
  SmoothedGradient gradient(7, 1.0);
  GradientMaps from_window;
  GradientMaps from_copy;
  gradient.compute(window, 30, &from_window);
  gradient.compute(window.clone(), 30, &from_copy);
  EXPECT_EQ(from_window.derivatives, from_copy.derivatives);
  EXPECT_EQ(from_window.strength, from_copy.strength);
}

}  // namespace
}  // namespace evolin
