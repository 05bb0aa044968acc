// edlines against hand-made images, the golden figures and OpenCV's EdgeDrawing.
#include "evolin_ros/detection/edlines.h"

#include <gtest/gtest.h>

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
  frame.image = test::noise(240, 320, CV_8UC1);
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

}  // namespace
}  // namespace evolin
