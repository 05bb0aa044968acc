// edlines against hand-made images, the golden figures and OpenCV's EdgeDrawing.
#include "evolin_ros/detection/edlines.h"

#include <gtest/gtest.h>

#include <cstring>

#include "evolin_ros/detection/opencv_edlines.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class EdLinesTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  EdLines detector_;
};

TEST_F(EdLinesTest, NamesWhatIsWrongWithAParameter) {
  EdLines fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{kernal: 3}")); },
                                 {"edlines", "kernal", "kernel"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{kernel: 4}")); },
                                 {"edlines", "kernel", "odd", "4"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{min_line_length: 2}")); },
                                 {"min_line_length", "3", "2"});
}

TEST_F(EdLinesTest, FindsBothSidesOfABar) {
  test::expectFindsBothSidesOfABar(&detector_, 90, 1e-9);
}

// Noise has edges, but hardly a line that its gradients agree with.
TEST_F(EdLinesTest, ValidationDropsWhatNoiseHas) {
  Frame frame;
  frame.image = test::uniformNoise({320, 240}, CV_8UC1);
  EdLines without;
  without.configure(YAML::Load("{validate: false}"));
  const std::size_t all = without.detect(frame).size();
  EXPECT_GT(all, 100U);
  EXPECT_LT(detector_.detect(frame).size(), all / 20);
}

TEST_F(EdLinesTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<EdLines>(
      {"{kernel: 1}", "{kernel: 15, sigma: 5}", "{gradient_threshold: 1, validate: false}",
       "{gradient_threshold: 1530}", "{anchor_threshold: 20}", "{scan_interval: 64}",
       "{min_path_length: 2, min_line_length: 3, validate: false}",
       "{first_fit_error: 10, pixel_distance: 10, validate: false}",
       "{first_fit_error: 0.01, pixel_distance: 0.01}",
       "{join_distance: 1000, join_error: 100, validate: false}"});
}

TEST_F(EdLinesTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  test::expectNearGolden(&detector_, "edlines", 0.98, 0.01);
}

/// Expects that of OpenCV's lines on `frames` at least `share` are ours within 0.01 px, and as many
/// of ours OpenCV's; records the counts under `name`.
void expectEqualsOpenCv(const std::string& name, const std::string& ours, const std::string& theirs,
                        const std::vector<Frame>& frames, double share) {
  OpenCvEdLines reference;
  reference.configure(YAML::Load(theirs));
  EdLines detector;
  detector.configure(YAML::Load(ours));
  const auto countSame = [](const LineSegments& of, const LineSegments& among) {
    return std::count_if(of.begin(), of.end(), [&](const LineSegment& line) {
      return std::any_of(among.begin(), among.end(), [&](const LineSegment& one) {
        return test::endpointDistance(line, one) < 0.01;
      });
    });
  };
  std::size_t expected = 0;
  std::size_t found = 0;
  std::ptrdiff_t same = 0;
  std::ptrdiff_t theirs_too = 0;
  for (const Frame& frame : frames) {
    const LineSegments golden = reference.detect(frame);
    const LineSegments lines = detector.detect(frame);
    expected += golden.size();
    found += lines.size();
    same += countSame(golden, lines);
    theirs_too += countSame(lines, golden);
  }
  ::testing::Test::RecordProperty(name, std::to_string(same) + " of " + std::to_string(expected) +
                                            ", " + std::to_string(theirs_too) + " of " +
                                            std::to_string(found));
  ASSERT_GT(expected, 20U) << theirs;
  EXPECT_GE(static_cast<double>(same), share * static_cast<double>(expected)) << theirs;
  EXPECT_GE(static_cast<double>(theirs_too), share * static_cast<double>(found)) << theirs;
}

TEST_F(EdLinesTest, EqualsOpenCvOnNoiseBeforeValidation) {
  if (!OpenCvEdLines().whyUnavailable().empty()) {
    GTEST_SKIP() << OpenCvEdLines().whyUnavailable();
  }
  Frame frame;
  cv::GaussianBlur(test::uniformNoise({400, 300}, CV_8UC1), frame.image, cv::Size(5, 5), 1.2);
  expectEqualsOpenCv("noise", "{validate: false}", "{nfa_validation: false}", {frame}, 0.98);
  for (const char* parameter : {"gradient_threshold: 40", "anchor_threshold: 8", "scan_interval: 3",
                                "min_line_length: 12"}) {
    const std::string name = "noise_" + std::string(parameter, std::strchr(parameter, ':'));
    expectEqualsOpenCv(name, "{validate: false, " + std::string(parameter) + "}",
                       "{nfa_validation: false, " + std::string(parameter) + "}", {frame}, 0.97);
  }
}

TEST_F(EdLinesTest, EqualsOpenCvOnRealFramesButForAFewThatValidationTakesOrLeaves) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (!OpenCvEdLines().whyUnavailable().empty()) {
    GTEST_SKIP() << OpenCvEdLines().whyUnavailable();
  }
  std::vector<Frame> frames;
  for (int i = 0; i < test::kGoldenFrames; ++i) {
    frames.push_back(test::goldenGray(i));
  }
  expectEqualsOpenCv("before_validation", "{validate: false}", "{nfa_validation: false}", frames,
                     0.995);
  expectEqualsOpenCv("after_validation", "{}", "{}", frames, 0.985);
}

}  // namespace
}  // namespace evolin
