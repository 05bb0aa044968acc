// kht against hand-made images and the golden figures.
#include "evolin_ros/detection/kht.h"

#include <gtest/gtest.h>

#include <optional>

#include "evolin_ros/geometry/clipping.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class KhtTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Kht detector_;
};

TEST_F(KhtTest, NamesWhatIsWrongWithAParameter) {
  Kht fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{detla: 1}")); },
                                 {"detector kht", "detla", "delta"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{delta: 0}")); },
                                 {"delta", "0.1", "10"});
}

TEST_F(KhtTest, CutsAnEdgesLineToTheImage) {
  Frame frame;
  frame.image = cv::Mat(100, 120, CV_8UC1, cv::Scalar(30));
  frame.image(cv::Rect(0, 40, 60, 60)).setTo(220);
  const LineSegments lines = detector_.detect(frame);
  ASSERT_GE(lines.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    // The first two are the square's sides, but as long as the image.
    const LineSegment& line = lines[i];
    const bool level = std::abs(line.x1 - line.x2) > std::abs(line.y1 - line.y2);
    EXPECT_NEAR(line.length(), level ? 120 : 100, 1e-9);
    EXPECT_NEAR(level ? line.y1 : line.x1, level ? 39.5 : 59.5, 1.1);
  }
  EXPECT_EQ(lines.front().score, 1);
  EXPECT_EQ(lines.back().score, 0);
  for (std::size_t i = 1; i < lines.size(); ++i) EXPECT_LT(lines[i].score, lines[i - 1].score);
}

TEST_F(KhtTest, ExtremeParametersWork) {
  for (const char* parameters :
       {"{canny_threshold1: 0, canny_threshold2: 0}", "{min_cluster: 3, min_deviation: 0.1}",
        "{min_cluster: 1000}", "{min_deviation: 100}", "{delta: 0.25}", "{delta: 10}",
        "{min_height: 0, sigmas: 1}", "{min_height: 1}", "{sigmas: 4}"}) {
    SCOPED_TRACE(parameters);
    Kht detector;
    detector.configure(YAML::Load(parameters));
    test::expectSurvivesAdversarialImages(&detector);
  }
}

// The golden lines run over the whole width of the image or beyond its rows. Of the weak ones many
// have equally many votes, and which of them comes first, and hides the others, is arbitrary.
TEST_F(KhtTest, EqualsTheStrongestGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  constexpr std::size_t kStrongest = 40;
  std::size_t near = 0;
  for (int frame = 0; frame < test::kGoldenFrames; ++frame) {
    const Frame gray = test::goldenGray(frame);
    const Rectangle image{-0.5, -0.5, gray.image.cols - 0.5, gray.image.rows - 0.5};
    LineSegments lines = detector_.detect(gray);
    LineSegments all =
        readLinesCsv(test::goldenFolder() / "kht" / "lines" / (test::goldenStem(frame) + ".csv"));
    ASSERT_GE(all.size(), kStrongest);
    all.resize(kStrongest);
    for (const LineSegment& golden : all) {
      // Longer at both ends, as those end at the outermost pixels' centres.
      LineSegment longer = golden;
      longer.x1 = 2 * golden.x1 - golden.x2;
      longer.y1 = 2 * golden.y1 - golden.y2;
      longer.x2 = 2 * golden.x2 - golden.x1;
      longer.y2 = 2 * golden.y2 - golden.y1;
      const std::optional<LineSegment> expected = clipToRectangle(longer, image);
      ASSERT_TRUE(expected.has_value());
      const auto at = std::find_if(lines.begin(), lines.end(), [&](const LineSegment& line) {
        return test::endpointDistance(line, *expected) < 1;
      });
      if (at != lines.end()) {
        ++near;
        lines.erase(at);
      }
    }
  }
  const double share = static_cast<double>(near) / (kStrongest * test::kGoldenFrames);
  EXPECT_GE(share, 0.95);
  RecordProperty("near_share", std::to_string(share));
}

}  // namespace
}  // namespace evolin
