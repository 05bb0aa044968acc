// hough_p against hand-made images and the golden figures.
#include "evolin_ros/detection/hough_p.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/awkward_images.h"
#include "test/support/golden.h"

namespace evolin {
namespace {

LineSegments goldenLines(int index) {
  return readLinesCsv(test::goldenFolder() / "houghlinesp" / "lines" /
                      (test::goldenStem(index) + ".csv"));
}

class HoughPTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!detector_.whyUnavailable().empty()) {
      GTEST_SKIP() << detector_.whyUnavailable();
    }
    detector_.configure(YAML::Node());
  }

  HoughP detector_;
};

TEST_F(HoughPTest, FindsTheSidesOfAQuadrilateral) { test::expectFindsQuadrilateral(&detector_); }

TEST_F(HoughPTest, SurvivesAwkwardImages) { test::expectSurvivesAwkwardImages(&detector_); }

TEST_F(HoughPTest, RefusesOtherImages) { test::expectRefusesOtherImages(&detector_); }

TEST_F(HoughPTest, RefusesToDetectBeforeItIsConfigured) {
  HoughP fresh;
  Frame frame;
  frame.image = test::quadrilateralImage();
  EXPECT_THROW(fresh.detect(frame), Error);
}

TEST_F(HoughPTest, NamesAnUnknownParameter) {
  HoughP fresh;
  try {
    fresh.configure(YAML::Load("{min_line_length: 3}"));
    FAIL() << "accepted min_line_length";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "min_line_length");
    EXPECT_NE(std::string(error.what()).find("hough_p"), std::string::npos) << error.what();
  }
}

TEST_F(HoughPTest, NamesAValueOutOfRange) {
  HoughP fresh;
  try {
    fresh.configure(YAML::Load("{rho: 0}"));
    FAIL() << "accepted rho 0";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "rho");
  }
}

TEST_F(HoughPTest, EqualsTheGoldenLinesOnGreyImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenGray(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(HoughPTest, EqualsTheGoldenLinesOnColourImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenColor(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(HoughPTest, SurvivesCoarseTablesOfSmallImages) {
  HoughP coarse;
  coarse.configure(YAML::Load("{rho: 10, theta: 90, threshold: 1, min_length: 0}"));
  for (const cv::Size& size : test::awkwardSizes()) {
    Frame frame;
    frame.image = test::uniformNoise(size, CV_8UC1);
    ASSERT_NO_THROW(coarse.detect(frame)) << size.width << "x" << size.height;
  }
}

TEST_F(HoughPTest, RefusesAnEvenAperture) {
  HoughP fresh;
  EXPECT_THROW(fresh.configure(YAML::Load("{canny_aperture: 4}")), ConfigError);
}

}  // namespace
}  // namespace evolin
