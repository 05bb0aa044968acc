// The plug-in `lsdnet` with the authors' weights.
#include "evolin_ros/detection/lsdnet.h"

#include <gtest/gtest.h>

#include "test/detection/awkward_images.h"
#include "test/detection/network_golden.h"
#include "test/support/expect_error.h"
#include "test/support/models.h"

namespace evolin {
namespace {

class LsdNetTest : public ::testing::Test {
 protected:
  void SetUp() override {
    EVOLIN_REQUIRE_MODEL(model_);
    if (!whyNoNetworks().empty()) {
      GTEST_SKIP() << whyNoNetworks();
    }
  }

  std::unique_ptr<LsdNet> detector(const std::string& others = "{}") const {
    YAML::Node parameters = YAML::Load(others);
    parameters["model"] = model_.file.string();
    auto lsdnet = std::make_unique<LsdNet>();
    lsdnet->configure(parameters);
    return lsdnet;
  }

  void expectGolden(const std::string& set, const std::string& others) const {
    const std::unique_ptr<LsdNet> lsdnet = detector(others);
    std::size_t golden_lines = 0;
    std::size_t found = 0;
    std::size_t same = 0;
    for (int frame = 0; frame < test::kGoldenFrames; ++frame) {
      const LineSegments lines = lsdnet->detect(test::goldenColor(frame));
      const LineSegments golden = test::networkLines(set, frame);
      golden_lines += golden.size();
      found += lines.size();
      same += test::countSame(lines, golden, 0, 1e-5);
    }
    EXPECT_GE(static_cast<double>(same), 0.99 * static_cast<double>(golden_lines));
    EXPECT_NEAR(static_cast<double>(found), static_cast<double>(golden_lines),
                0.01 * static_cast<double>(golden_lines));
  }

  test::Model model_ = test::lsdNetModel();
};

TEST_F(LsdNetTest, EqualsTheGoldenLinesWithMendedAxes) { expectGolden("lsdnet_axisfix", "{}"); }

TEST_F(LsdNetTest, EqualsTheAuthorsLines) { expectGolden("lsdnet", "{compatible: true}"); }

TEST_F(LsdNetTest, EqualsTheBenchmarksLines) {
  expectGolden("lsdnet_bgr", "{compatible: true, channel_order: bgr}");
}

TEST_F(LsdNetTest, EqualsTheGoldenLinesOfASinglePass) {
  expectGolden("lsdnet_single_pass", "{compatible: true, single_pass: true}");
}

TEST_F(LsdNetTest, SurvivesAwkwardImages) {
  const std::unique_ptr<LsdNet> lsdnet = detector();
  for (const cv::Size& size :
       {cv::Size(1, 1), cv::Size(640, 1), cv::Size(3, 7), cv::Size(203, 97)}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      Frame frame;
      frame.image = test::uniformNoise(size, type);
      test::expectSound(lsdnet->detect(frame), *lsdnet, std::to_string(size.width));
    }
  }
  test::expectRefusesOtherImages(lsdnet.get());
}

TEST_F(LsdNetTest, SelectsAndTellsItsTimes) {
  const std::unique_ptr<LsdNet> lsdnet = detector("{max_lines: 7, score_threshold: 0.5}");
  EXPECT_EQ(lsdnet->detect(test::goldenColor(0)).size(), 7U);
  EXPECT_GT(lsdnet->times().preparing, 0);
  EXPECT_GT(lsdnet->times().forward, 0);
  EXPECT_GT(lsdnet->times().decoding, 0);
}

TEST_F(LsdNetTest, RefusesWhatItDoesNotKnow) {
  test::expectError<ConfigError>([&] { detector("{channel_order: grb}"); },
                                 {"detector lsdnet", "channel_order", "grb", "rgb", "bgr"});
  test::expectError<ConfigError>([&] { detector("{compatibel: true}"); },
                                 {"compatibel", "compatible"});
}

TEST_F(LsdNetTest, AnUnusableTargetIsUnavailable) {
  test::expectError<UnavailableError>([&] { detector("{backend: opencv, target: myriad}"); },
                                      {"detector lsdnet", "'opencv' on 'myriad'", "opencv on cpu"});
}

}  // namespace
}  // namespace evolin
