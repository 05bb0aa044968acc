// lswms against hand-made images and the golden figures.
#include "evolin_ros/detection/lswms.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class LswmsTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Lswms detector_;
};

TEST_F(LswmsTest, NamesWhatIsWrongWithAParameter) {
  Lswms fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{radios: 3}")); },
                                 {"detector lswms", "radios", "radius"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{score: error}")); },
                                 {"score", "error", "angle, length"});
}

// Steps in columns 40, 80 and 120 with gradients exactly across them. The grey between the sides
// gives each a ridge of one column; on one of two, mean shift goes to and fro and gives up.
TEST_F(LswmsTest, PerfectStepsHaveTheBestScore) {
  Frame frame;
  frame.image = cv::Mat(120, 160, CV_8UC1, cv::Scalar(40));
  frame.image.colRange(40, 80).setTo(200);
  frame.image.colRange(120, 160).setTo(200);
  for (const int x : {40, 80, 120}) frame.image.col(x).setTo(120);
  const LineSegments lines = detector_.detect(frame);
  ASSERT_EQ(lines.size(), 3U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double step = 40 * (static_cast<double>(i) + 1);
    EXPECT_EQ(lines[i].x1, step);
    EXPECT_EQ(lines[i].x2, step);
    EXPECT_GT(lines[i].length(), 100);
    EXPECT_DOUBLE_EQ(lines[i].score, 1);
  }
}

// Their average gradient is below 1, and the method asks for more than the average.
TEST_F(LswmsTest, FindsNothingInNearlyFlatImages) {
  Frame frame;
  frame.image = cv::Mat(120, 160, CV_8UC1, cv::Scalar(40));
  frame.image.colRange(80, 160).setTo(200);
  EXPECT_TRUE(detector_.detect(frame).empty());
}

TEST_F(LswmsTest, CompatibleLinesAreShiftedByTheMarginsExcess) {
  // The margin is 7, or 8 where the padded width would leave 2 or 3 over a multiple of 4.
  for (const int width : {316, 317, 318, 319, 320}) {
    Frame frame;
    cv::resize(test::quadrilateralImage(), frame.image, cv::Size(width, 240));
    Lswms compatible;
    compatible.configure(YAML::Load("{compatible: true}"));
    const LineSegments published = compatible.detect(frame);
    const LineSegments lines = detector_.detect(frame);
    ASSERT_EQ(lines.size(), published.size());
    ASSERT_FALSE(lines.empty());
    const double shift = (width + 14) % 4 < 2 ? 1 : 2;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(published[i].x1 - lines[i].x1, shift) << width;
      EXPECT_EQ(published[i].y2 - lines[i].y2, shift) << width;
    }
  }
}

TEST_F(LswmsTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<Lswms>({"{radius: 1}", "{radius: 15}", "{angle_tolerance: 1}",
                                            "{angle_tolerance: 45, max_error: 1.6}",
                                            "{max_error: 0.001}", "{score: length}",
                                            "{compatible: true}"});
}

TEST_F(LswmsTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  Lswms compatible;
  compatible.configure(YAML::Load("{compatible: true}"));
  const test::GoldenAgreement agreement = test::compareWithGolden(&compatible, "lswms", 0.001);
  EXPECT_GE(agreement.nearShare(), 0.98);
  EXPECT_NEAR(agreement.countRatio(), 1, 0.01);
  EXPECT_GE(agreement.scoreShare(), 0.99);
}

TEST_F(LswmsTest, EqualsTheGoldenLinesWithoutTheShift) {
  EVOLIN_REQUIRE_SHARED_DATA();
  Lswms length;
  length.configure(YAML::Load("{score: length}"));
  const test::GoldenAgreement agreement =
      test::compareWithGolden(&length, "lswms_shift_corrected", 0.001);
  EXPECT_GE(agreement.nearShare(), 0.98);
  EXPECT_GE(agreement.scoreShare(), 0.99);
}

}  // namespace
}  // namespace evolin
