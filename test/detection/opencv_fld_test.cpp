// opencv_fld against hand-made images and the golden figures.
#include "evolin_ros/detection/opencv_fld.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/awkward_images.h"
#include "test/support/golden.h"

namespace evolin {
namespace {

LineSegments goldenLines(int index) {
  return readLinesCsv(test::goldenFolder() / "fld" / "lines" / (test::goldenStem(index) + ".csv"));
}

class OpenCvFldTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!detector_.whyUnavailable().empty()) {
      GTEST_SKIP() << detector_.whyUnavailable();
    }
    detector_.configure(YAML::Node());
  }

  OpenCvFld detector_;
};

TEST_F(OpenCvFldTest, FindsTheSidesOfAQuadrilateral) { test::expectFindsQuadrilateral(&detector_); }

TEST_F(OpenCvFldTest, SurvivesAwkwardImages) { test::expectSurvivesAwkwardImages(&detector_); }

TEST_F(OpenCvFldTest, RefusesOtherImages) { test::expectRefusesOtherImages(&detector_); }

TEST_F(OpenCvFldTest, RefusesToDetectBeforeItIsConfigured) {
  OpenCvFld fresh;
  Frame frame;
  frame.image = test::quadrilateralImage();
  EXPECT_THROW(fresh.detect(frame), Error);
}

TEST_F(OpenCvFldTest, NamesAnUnknownParameter) {
  OpenCvFld fresh;
  try {
    fresh.configure(YAML::Load("{do_merge: 3}"));
    FAIL() << "accepted do_merge";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "do_merge");
    EXPECT_NE(std::string(error.what()).find("opencv_fld"), std::string::npos) << error.what();
  }
}

TEST_F(OpenCvFldTest, NamesAValueOutOfRange) {
  OpenCvFld fresh;
  try {
    fresh.configure(YAML::Load("{length_threshold: 0}"));
    FAIL() << "accepted length_threshold 0";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "length_threshold");
  }
}

TEST_F(OpenCvFldTest, EqualsTheGoldenLinesOnGreyImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenGray(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(OpenCvFldTest, EqualsTheGoldenLinesOnColourImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenColor(i)), goldenLines(i), 1e-3));
  }
}

}  // namespace
}  // namespace evolin
