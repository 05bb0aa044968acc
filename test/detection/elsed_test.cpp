// elsed against hand-made images and the golden figures.
#include "evolin_ros/detection/elsed.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class ElsedTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Elsed detector_;
};

TEST_F(ElsedTest, NamesWhatIsWrongWithAParameter) {
  Elsed fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{kernal: 3}")); },
                                 {"elsed", "kernal", "kernel"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{kernel: 4}")); },
                                 {"elsed", "kernel", "odd", "4"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{min_line_length: 3}")); },
                                 {"min_line_length", "4"});
}

// The sides that cross a gap: one segment with jumps over junctions, two without.
TEST_F(ElsedTest, GoesOnBeyondAGap) {
  Frame frame;
  frame.image = cv::Mat(120, 200, CV_8UC1, cv::Scalar(40));
  frame.image.rowRange(60, 120).setTo(200);
  frame.image(cv::Rect(96, 50, 3, 20)).setTo(120);
  const auto longest = [&](const char* parameters) {
    Elsed detector;
    detector.configure(YAML::Load(parameters));
    double length = 0;
    for (const LineSegment& line : detector.detect(frame)) {
      length = std::max(length, line.length());
    }
    return length;
  };
  EXPECT_GT(longest("{}"), 180);
  EXPECT_LT(longest("{junctions: false}"), 120);
}

// A step between two rows: the segment lies on it, and nearly every pixel agrees.
TEST_F(ElsedTest, ScoresAreThePixelsThatAgree) {
  Frame frame;
  frame.image = cv::Mat(80, 100, CV_8UC1, cv::Scalar(40));
  frame.image.rowRange(40, 80).setTo(200);
  const LineSegments lines = detector_.detect(frame);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].y1, 39.5, 0.6);
  EXPECT_NEAR(lines[0].y2, 39.5, 0.6);
  EXPECT_LE(lines[0].score, lines[0].length() + 1);
  EXPECT_GE(lines[0].score, lines[0].length() - 11);
}

TEST_F(ElsedTest, WindowsOfAllSizesWork) {
  for (int kernel = 1; kernel <= 15; kernel += 2) {
    YAML::Node parameters;
    parameters["kernel"] = kernel;
    parameters["sigma"] = 0.3 + kernel / 6.0;
    Elsed detector;
    detector.configure(parameters);
    SCOPED_TRACE(kernel);
    test::expectSurvivesAwkwardImages(&detector);
    test::expectFindsQuadrilateral(&detector);
  }
}

TEST_F(ElsedTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<Elsed>(
      {"{max_outliers: 0}", "{max_outliers: 100, min_line_length: 4}",
       "{gradient_threshold: 1, anchor_threshold: 0, scan_interval: 1}",
       "{pixel_distance: 10, line_fit_error: 100}", "{scan_interval: 64, validate: false}",
       "{gradient_threshold: 2040}", "{anchor_threshold: 2040}"});
}

TEST_F(ElsedTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const test::GoldenAgreement agreement = test::compareWithGolden(&detector_, "elsed", 0);
  EXPECT_EQ(agreement.near, agreement.golden);
  EXPECT_EQ(agreement.found, agreement.golden);
  EXPECT_GE(agreement.scoreShare(), 0.997);
}

TEST_F(ElsedTest, EqualsTheGoldenLinesOfTheAuthorsWindow) {
  EVOLIN_REQUIRE_SHARED_DATA();
  Elsed five;
  five.configure(YAML::Load("{kernel: 5}"));
  const test::GoldenAgreement agreement = test::compareWithGolden(&five, "elsed_ksize5", 0);
  EXPECT_EQ(agreement.near, agreement.golden);
  EXPECT_EQ(agreement.found, agreement.golden);
  EXPECT_GE(agreement.scoreShare(), 0.997);
}

}  // namespace
}  // namespace evolin
