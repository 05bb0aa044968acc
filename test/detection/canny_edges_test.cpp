// The Canny filter on our gradients against OpenCV's.
#include "canny_edges.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "marked_pixels.h"
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
  std::vector<test::NamedImage> images = test::adversarialImages();
  cv::Mat smooth;
  cv::GaussianBlur(test::uniformNoise({160, 120}, CV_8UC1), smooth, cv::Size(5, 5), 1.5);
  images.push_back({"smooth noise", smooth});
  images.push_back({"quadrilateral", test::quadrilateralImage()});
  for (const cv::Size& size : test::awkwardSizes()) {
    if (size.width > 1 && size.height > 1) {
      images.push_back({"awkward size", test::uniformNoise(size, CV_8UC1)});
    }
  }
  for (auto& [name, image] : images) {
    if (image.channels() == 3) {
      cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    }
    expectEqualsOpenCv(image, 50, 50, name);
    expectEqualsOpenCv(image, 80, 200, name);
    expectEqualsOpenCv(image, 300.7, 20.9, name);
    expectEqualsOpenCv(image, 0, 1e6, name);
  }
}

TEST(CannyEdges, WindowsDoNotSeeWhatIsAroundThem) {
  const cv::Mat whole = test::uniformNoise({90, 80}, CV_8UC1);
  const cv::Mat window = whole(cv::Rect(11, 7, 40, 50));
  CannyEdges of_window;
  CannyEdges of_copy;
  of_window.findByOpenCv(window, 100, 300, 5);
  of_copy.findByOpenCv(window.clone(), 100, 300, 5);
  for (int y = 0; y < 50; ++y) {
    EXPECT_TRUE(std::equal(of_window.row(y), of_window.row(y) + 40, of_copy.row(y))) << y;
  }
}

TEST(VisitMarked, VisitsWhatIsSetWhenItsTurnComes) {
  std::vector<std::uint8_t> row(40, 0);
  for (const int x : {0, 3, 7, 8, 17, 38, 39}) row[static_cast<std::size_t>(x)] = 1;
  std::vector<int> visited;
  visitMarked(row.data(), 3, 39, 1, [&](int x) {
    visited.push_back(x);
    row[8] = 0;
  });
  EXPECT_EQ(visited, (std::vector<int>{3, 7, 17, 38}));
}

}  // namespace
}  // namespace evolin
