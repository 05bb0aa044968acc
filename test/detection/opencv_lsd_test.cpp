// opencv_lsd against hand-made images and the golden figures.
#include "evolin_ros/detection/opencv_lsd.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/awkward_images.h"
#include "test/support/golden.h"
#include "test/support/lsd_release.h"

namespace evolin {
namespace {

LineSegments goldenLines(int index) {
  return readLinesCsv(test::goldenFolder() / "lsd" / "lines" / (test::goldenStem(index) + ".csv"));
}

class OpenCvLsdTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!detector_.whyUnavailable().empty()) {
      GTEST_SKIP() << detector_.whyUnavailable();
    }
    detector_.configure(YAML::Node());
  }

  OpenCvLsd detector_;
};

TEST_F(OpenCvLsdTest, FindsTheSidesOfAQuadrilateral) { test::expectFindsQuadrilateral(&detector_); }

TEST_F(OpenCvLsdTest, SurvivesAwkwardImages) { test::expectSurvivesAwkwardImages(&detector_); }

TEST_F(OpenCvLsdTest, RefusesOtherImages) { test::expectRefusesOtherImages(&detector_); }

TEST_F(OpenCvLsdTest, RefusesToDetectBeforeItIsConfigured) {
  OpenCvLsd fresh;
  Frame frame;
  frame.image = test::quadrilateralImage();
  EXPECT_THROW(fresh.detect(frame), Error);
}

TEST_F(OpenCvLsdTest, NamesAnUnknownParameter) {
  OpenCvLsd fresh;
  try {
    fresh.configure(YAML::Load("{angle_tolerence: 3}"));
    FAIL() << "accepted angle_tolerence";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "angle_tolerence");
    EXPECT_NE(std::string(error.what()).find("opencv_lsd"), std::string::npos) << error.what();
  }
}

TEST_F(OpenCvLsdTest, NamesAValueOutOfRange) {
  OpenCvLsd fresh;
  try {
    fresh.configure(YAML::Load("{scale: 5}"));
    FAIL() << "accepted scale 5";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.key(), "scale");
  }
}

TEST_F(OpenCvLsdTest, EqualsTheGoldenLinesOnGreyImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = test::whyLsdDiffers(); !why.empty()) {
    GTEST_SKIP() << why;
  }
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenGray(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(OpenCvLsdTest, EqualsTheGoldenLinesOnColourImages) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = test::whyLsdDiffers(); !why.empty()) {
    GTEST_SKIP() << why;
  }
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    EXPECT_TRUE(test::linesNear(detector_.detect(test::goldenColor(i)), goldenLines(i), 1e-3));
  }
}

TEST_F(OpenCvLsdTest, EqualsTheGoldenScores) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = test::whyLsdDiffers(); !why.empty()) {
    GTEST_SKIP() << why;
  }
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    SCOPED_TRACE(test::goldenStem(i));
    const LineSegments lines = detector_.detect(test::goldenGray(i));
    const std::vector<double> golden =
        readScoresCsv(test::goldenFolder() / "lsd" / "scores" / (test::goldenStem(i) + ".csv"));
    ASSERT_EQ(lines.size(), golden.size());
    for (std::size_t k = 0; k < lines.size(); ++k) {
      EXPECT_NEAR(lines[k].score, golden[k], 1e-6 * std::abs(golden[k]) + 1e-6) << "line " << k;
    }
  }
}

TEST_F(OpenCvLsdTest, GivesScoresOnlyWithAdvancedRefinement) {
  OpenCvLsd standard;
  standard.configure(YAML::Load("{refine: standard}"));
  EXPECT_FALSE(standard.givesScores());
  EXPECT_TRUE(detector_.givesScores());
  Frame frame;
  frame.image = test::quadrilateralImage();
  const LineSegments lines = standard.detect(frame);
  ASSERT_FALSE(lines.empty());
  for (const LineSegment& line : lines) {
    EXPECT_FALSE(line.hasScore());
  }
}

TEST_F(OpenCvLsdTest, SurvivesCoarseScalesOfSmallImages) {
  OpenCvLsd coarse;
  coarse.configure(YAML::Load("{scale: 0.1}"));
  test::expectSurvivesAwkwardImages(&coarse);
}

}  // namespace
}  // namespace evolin
