// cannylines against hand-made images and the golden figures.
#include "evolin_ros/detection/cannylines.h"

#include <gtest/gtest.h>

#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class CannyLinesTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  CannyLines detector_;
};

TEST_F(CannyLinesTest, NamesWhatIsWrongWithAParameter) {
  CannyLines fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{sigmas: 1}")); },
                                 {"detector cannylines", "sigmas", "sigma"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{fit_error: 0}")); },
                                 {"fit_error", "0.01", "10"});
}

TEST_F(CannyLinesTest, FindsBothSidesOfABar) {
  test::expectFindsBothSidesOfABar(&detector_, 90, 1e-3);
  CannyLines exact;
  exact.configure(YAML::Load("{compatible: false}"));
  test::expectFindsBothSidesOfABar(&exact, 90, 1e-6);
}

TEST_F(CannyLinesTest, ValidationDropsWhatNoiseHas) {
  Frame frame;
  frame.image = test::uniformNoise({320, 240}, CV_8UC1);
  CannyLines without;
  without.configure(YAML::Load("{validate: false}"));
  const std::size_t all = without.detect(frame).size();
  EXPECT_GT(all, 10U);
  EXPECT_LT(detector_.detect(frame).size(), all / 10);
}

TEST_F(CannyLinesTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<CannyLines>(
      {"{sigma: 0.1}", "{sigma: 10}", "{meaningful_gradient: 1, validate: false}",
       "{meaningful_gradient: 2040}", "{fit_error: 0.01}", "{fit_error: 10, validate: false}",
       "{compatible: false, validate: false}"});
}

// Errors of the published sums grow with the distance from the corner; ours have none.
TEST_F(CannyLinesTest, OnlyCompatibleFitsHangOnThePlaceInTheImage) {
  Frame near;
  near.image = cv::Mat(2200, 2200, CV_8UC1, cv::Scalar(30));
  const std::vector<cv::Point> shape = {{20, 30}, {170, 70}, {150, 180}, {40, 160}};
  cv::fillConvexPoly(near.image, shape, cv::Scalar(220), cv::LINE_AA);
  Frame far;
  far.image = cv::Mat(2200, 2200, CV_8UC1, cv::Scalar(30));
  std::vector<cv::Point> there = shape;
  for (cv::Point& corner : there) corner += cv::Point(1990, 1990);
  cv::fillConvexPoly(far.image, there, cv::Scalar(220), cv::LINE_AA);
  const auto greatestMove = [&](CannyLines* detector) {
    const LineSegments a = detector->detect(near);
    const LineSegments b = detector->detect(far);
    EXPECT_GE(a.size(), 4U);
    EXPECT_EQ(a.size(), b.size());
    double greatest = 0;
    for (LineSegment line : a) {
      line.x1 += 1990;
      line.y1 += 1990;
      line.x2 += 1990;
      line.y2 += 1990;
      double least = 1e9;
      for (const LineSegment& other : b) {
        least = std::min(least, test::endpointDistance(line, other));
      }
      greatest = std::max(greatest, least);
    }
    return greatest;
  };
  CannyLines exact;
  exact.configure(YAML::Load("{compatible: false}"));
  const double move = greatestMove(&exact);
  const double compatible_move = greatestMove(&detector_);
  RecordProperty("move", std::to_string(move));
  RecordProperty("compatible_move", std::to_string(compatible_move));
  EXPECT_LT(move, 1e-6);
  EXPECT_GT(compatible_move, 0.1);
}

// What is left differs by the order of equally strong seeds (docs/METHODS.md).
TEST_F(CannyLinesTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  test::expectNearGolden(&detector_, "cannylines_cpp_sigma1", 0.95, 0.02);
}

TEST_F(CannyLinesTest, IsNearTheGoldenLinesWithExactFits) {
  EVOLIN_REQUIRE_SHARED_DATA();
  CannyLines exact;
  exact.configure(YAML::Load("{compatible: false}"));
  test::expectNearGolden(&exact, "cannylines_cpp_sigma1", 0.93, 0.02);
}

}  // namespace
}  // namespace evolin
