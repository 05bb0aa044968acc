// fld against hand-made images, the golden figures and OpenCV's own class.
#include "evolin_ros/detection/fld.h"

#include <gtest/gtest.h>

#include "evolin_ros/detection/opencv_fld.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class FldTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Fld detector_;
};

TEST_F(FldTest, NamesWhatIsWrongWithAParameter) {
  Fld fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{merge: true}")); },
                                 {"detector fld", "merge"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{canny_aperture: 4}")); },
                                 {"canny_aperture", "4"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{length_threshold: 1}")); },
                                 {"length_threshold", "1", "2"});
}

TEST_F(FldTest, FindsBothSidesOfABar) { test::expectFindsBothSidesOfABar(&detector_, 95, 1e-4); }

TEST_F(FldTest, LeavesOutLinesAlongTheBorder) {
  Frame frame;
  frame.image = cv::Mat(100, 120, CV_8UC1, cv::Scalar(30));
  frame.image.colRange(0, 4).setTo(220);
  EXPECT_TRUE(detector_.detect(frame).empty());
  frame.image.colRange(0, 8).setTo(220);
  EXPECT_EQ(detector_.detect(frame).size(), 1U);
}

TEST_F(FldTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<Fld>(
      {"{length_threshold: 2}", "{length_threshold: 1000}", "{distance_threshold: 0.001}",
       "{distance_threshold: 100}", "{canny_threshold1: 0.001, canny_threshold2: 0.001}",
       "{canny_aperture: 5}", "{canny_aperture: 7}"});
}

/// The same lines but for a few that hang on the last bit of a distance.
void expectEqualsOpenCv(const std::string& parameters, const Frame& frame) {
  OpenCvFld theirs;
  if (!theirs.whyUnavailable().empty()) {
    GTEST_SKIP() << theirs.whyUnavailable();
  }
  theirs.configure(YAML::Load(parameters));
  Fld ours;
  ours.configure(YAML::Load(parameters));
  const LineSegments golden = theirs.detect(frame);
  const LineSegments lines = ours.detect(frame);
  const auto expected = static_cast<double>(golden.size());
  EXPECT_NEAR(static_cast<double>(lines.size()), expected, 0.005 * expected) << parameters;
  std::size_t near = 0;
  for (const LineSegment& line : lines) {
    near += std::any_of(
                golden.begin(), golden.end(),
                [&](const LineSegment& one) { return test::endpointDistance(line, one) < 0.01; })
                ? 1
                : 0;
  }
  EXPECT_GE(static_cast<double>(near), 0.995 * expected) << parameters;
}

TEST_F(FldTest, EqualsOpenCvOnNoise) {
  Frame frame;
  cv::GaussianBlur(test::uniformNoise({400, 300}, CV_8UC1), frame.image, cv::Size(5, 5), 1.2);
  ASSERT_GT(detector_.detect(frame).size(), 300U);
  for (const char* parameters :
       {"{}", "{length_threshold: 5}", "{length_threshold: 20, distance_threshold: 3}",
        "{canny_threshold1: 30, canny_threshold2: 90}", "{canny_aperture: 5}"}) {
    expectEqualsOpenCv(parameters, frame);
  }
}

TEST_F(FldTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  test::expectNearGolden(&detector_, "fld", 0.99, 0.01);
}

}  // namespace
}  // namespace evolin
