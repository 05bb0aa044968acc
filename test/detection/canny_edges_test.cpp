// The Canny filter on our gradients against OpenCV's.
#include "canny_edges.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "test/detection/own_detectors.h"

namespace evolin {
namespace {

void expectEqualsOpenCv(const cv::Mat& image, double low, double high, const std::string& what) {
  SmoothedGradient gradient(1, 1.0);
  GradientMaps maps;
  gradient.compute(image, CannyEdges::leastStrength(low, high), &maps);
  CannyEdges ours;
  ours.find(maps, low, high);
  CannyEdges theirs;
  theirs.findByOpenCv(image, low, high, 3);
  for (int y = -1; y <= image.rows; ++y) {
    for (int x = -1; x <= image.cols; ++x) {
      ASSERT_EQ(static_cast<int>(ours.row(y)[x]), static_cast<int>(theirs.row(y)[x]))
          << what << " at " << x << ", " << y << ", thresholds " << low << " and " << high;
    }
  }
}

TEST(CannyEdges, EqualOpenCvs) {
  std::vector<std::pair<std::string, cv::Mat>> images = test::adversarialImages();
  cv::Mat smooth;
  cv::GaussianBlur(test::noise(120, 160, CV_8UC1), smooth, cv::Size(5, 5), 1.5);
  images.emplace_back("smooth noise", smooth);
  images.emplace_back("quadrilateral", test::quadrilateralImage());
  for (const cv::Size& size : test::awkwardSizes()) {
    if (size.width > 1 && size.height > 1) {
      images.emplace_back("awkward size", test::noise(size.height, size.width, CV_8UC1));
    }
  }
  for (const auto& [name, image] : images) {
    expectEqualsOpenCv(image, 50, 50, name);
    expectEqualsOpenCv(image, 80, 200, name);
    expectEqualsOpenCv(image, 300.7, 20.9, name);
    expectEqualsOpenCv(image, 0, 1e6, name);
  }
}

TEST(CannyEdges, WindowsDoNotSeeWhatIsAroundThem) {
  const cv::Mat whole = test::noise(80, 90, CV_8UC1);
  const cv::Mat window = whole(cv::Rect(11, 7, 40, 50));
  CannyEdges of_window;
  CannyEdges of_copy;
  of_window.findByOpenCv(window, 100, 300, 5);
  of_copy.findByOpenCv(window.clone(), 100, 300, 5);
  for (int y = 0; y < 50; ++y) {
    EXPECT_TRUE(std::equal(of_window.row(y), of_window.row(y) + 40, of_copy.row(y))) << y;
  }
}

TEST(CannyEdges, VisitsWhatIsSetWhenItsTurnComes) {
  std::vector<std::uint8_t> row(40, 0);
  for (const int x : {0, 3, 7, 8, 17, 38, 39}) row[static_cast<std::size_t>(x)] = 1;
  std::vector<int> visited;
  visitEdges(row.data(), 3, 39, [&](int x) {
    visited.push_back(x);
    row[8] = 0;
  });
  EXPECT_EQ(visited, (std::vector<int>{3, 7, 17, 38}));
}

}  // namespace
}  // namespace evolin
