// opencv_edlines against hand-made images and the golden figures.
#include "evolin_ros/detection/opencv_edlines.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/awkward_images.h"
#include "test/support/golden.h"

namespace evolin {
namespace {

LineSegments goldenLines(int index) {
  return readLinesCsv(test::goldenFolder() / "edlines" / "lines" /
                      (test::goldenStem(index) + ".csv"));
}

class OpenCvEdLinesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!detector_.whyUnavailable().empty()) {
      GTEST_SKIP() << detector_.whyUnavailable();
    }
    detector_.configure(YAML::Node());
  }

  OpenCvEdLines detector_;
};

TEST_F(OpenCvEdLinesTest, FindsTheSidesOfAQuadrilateral) {
  test::expectFindsQuadrilateral(&detector_);
}

TEST_F(OpenCvEdLinesTest, SurvivesAwkwardImages) { test::expectSurvivesAwkwardImages(&detector_); }

TEST_F(OpenCvEdLinesTest, RefusesOtherImages) { test::expectRefusesOtherImages(&detector_); }

TEST_F(OpenCvEdLinesTest, RefusesToDetectBeforeItIsConfigured) {
  OpenCvEdLines fresh;
  Frame frame;
  frame.image = test::quadrilateralImage();
  EXPECT_THROW(fresh.detect(frame), Error);
}

TEST_F(OpenCvEdLinesTest, NamesAnUnknownParameter) {
  OpenCvEdLines fresh;
  try {
    fresh.configure(YAML::Load("{sigmas: 3}"));
    FAIL() << "accepted sigmas";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "sigmas");
    EXPECT_NE(std::string(error.what()).find("opencv_edlines"), std::string::npos) << error.what();
  }
}

TEST_F(OpenCvEdLinesTest, NamesAValueOutOfRange) {
  OpenCvEdLines fresh;
  try {
    fresh.configure(YAML::Load("{scan_interval: 0}"));
    FAIL() << "accepted scan_interval 0";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "scan_interval");
  }
}

TEST_F(OpenCvEdLinesTest, EqualsTheGoldenLinesOnGreyImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenGray(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(OpenCvEdLinesTest, EqualsTheGoldenLinesOnColourImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenColor(i)), goldenLines(i), 1e-3));
  }
}

}  // namespace
}  // namespace evolin
