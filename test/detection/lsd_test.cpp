// lsd against hand-made images, the golden figures, and OpenCV's LSD.
#include "evolin_ros/detection/lsd.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/opencv_lsd.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"
#include "test/support/lsd_release.h"

namespace evolin {
namespace {

class LsdTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Lsd detector_;
};

Lsd* configured(Lsd* detector, const char* parameters) {
  detector->configure(YAML::Load(parameters));
  return detector;
}

TEST_F(LsdTest, NamesWhatIsWrongWithAParameter) {
  Lsd fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{log_epsilon: 3}")); },
                                 {"detector lsd", "log_epsilon", "log_eps"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{scale: 5}")); },
                                 {"scale", "5"});
}

TEST_F(LsdTest, FollowsTheArticleToo) {
  Lsd article;
  test::expectFindsQuadrilateral(configured(&article, "{compatible: false}"));
  test::expectSurvivesAwkwardImages(&article);
  // The published library's tail is too thin: its scores are higher.
  Frame frame;
  frame.image = test::quadrilateralImage();
  const auto best = [](const LineSegments& lines) {
    double score = -1e9;
    for (const LineSegment& line : lines) score = std::max(score, line.score);
    return score;
  };
  const double article_score = best(article.detect(frame));
  EXPECT_GT(article_score, 50);
  EXPECT_GT(best(detector_.detect(frame)), 1.5 * article_score);
}

// The article's promise: at log_eps 0, on average one line in an image of noise.
TEST_F(LsdTest, FindsHardlyALineInNoise) {
  Lsd article;
  configured(&article, "{compatible: false}");
  std::size_t lines = 0;
  constexpr int kImages = 5;
  for (int i = 0; i < kImages; ++i) {
    Frame frame;
    frame.image = test::uniformNoise({300, 200 + i}, CV_8UC1);
    lines += article.detect(frame).size();
  }
  EXPECT_LE(lines, static_cast<std::size_t>(3 * kImages));
}

TEST_F(LsdTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<Lsd>(
      {"{scale: 0.1}", "{scale: 1}", "{scale: 1.7}", "{refine: none}", "{refine: standard}",
       "{quantization: 0}", "{quantization: 255}", "{quantization: 255, angle_tolerance: 0.1}",
       "{bins: 1}", "{bins: 65536}", "{bins: 65536, compatible: false}", "{angle_tolerance: 89}",
       "{density_threshold: 0.99}", "{log_eps: 1000}", "{log_eps: -1000}"});
}

TEST_F(LsdTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const test::GoldenAgreement agreement = test::compareWithGolden(&detector_, "lsd", 0.01);
  EXPECT_GE(agreement.nearShare(), 0.99);
  EXPECT_NEAR(agreement.countRatio(), 1, 0.01);
  EXPECT_GE(agreement.scoreShare(), 0.99);
}

// Line for line, also where other parameters lead elsewhere than the golden figures.
TEST_F(LsdTest, EqualsOpenCvWithOtherParameters) {
  EVOLIN_REQUIRE_SHARED_DATA();
  OpenCvLsd library;
  if (!library.whyUnavailable().empty() || !test::whyLsdDiffers().empty()) {
    GTEST_SKIP() << library.whyUnavailable() << test::whyLsdDiffers();
  }
  for (const char* parameters : {"{refine: none}", "{refine: standard}", "{scale: 1}",
                                 "{scale: 0.5, angle_tolerance: 30}", "{log_eps: 10, bins: 256}"}) {
    OpenCvLsd theirs;
    Lsd ours;
    theirs.configure(YAML::Load(parameters));
    ours.configure(YAML::Load(parameters));
    std::size_t near = 0;
    std::size_t all = 0;
    for (int i = 0; i < test::kGoldenFrames; ++i) {
      const Frame frame = test::goldenGray(i);
      const LineSegments found = ours.detect(frame);
      for (const LineSegment& line : theirs.detect(frame)) {
        ++all;
        near += std::any_of(found.begin(), found.end(), [&](const LineSegment& other) {
          return test::endpointDistance(line, other) <= 1;
        });
      }
    }
    EXPECT_GE(static_cast<double>(near), 0.98 * static_cast<double>(all)) << parameters;
  }
}

}  // namespace
}  // namespace evolin
