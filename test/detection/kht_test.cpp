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

// The golden figures are rho in pixels and theta in degrees, from the image's middle. A line that
// leaves the image is in neither; one that only touches a corner may be in one of both.
TEST_F(KhtTest, EqualsTheGoldenLinesInTheirOrder) {
  EVOLIN_REQUIRE_SHARED_DATA();
  std::size_t golden_lines = 0;
  std::size_t near = 0;
  std::size_t found = 0;
  for (int frame = 0; frame < test::kGoldenFrames; ++frame) {
    const Frame gray = test::goldenGray(frame);
    const double width = gray.image.cols;
    const double height = gray.image.rows;
    const LineSegments lines = detector_.detect(gray);
    found += lines.size();
    std::size_t next = 0;
    for (const std::vector<double>& row :
         test::readTable(test::goldenFolder() / "kht_rho_theta" / "lines" /
                         (test::goldenStem(frame) + ".csv"))) {
      const double theta = row.at(1) * CV_PI / 180;
      LineSegment line;
      line.x1 = width / 2 + row.at(0) * std::cos(theta) - 2 * width * std::sin(theta);
      line.y1 = height / 2 + row.at(0) * std::sin(theta) + 2 * width * std::cos(theta);
      line.x2 = width / 2 + row.at(0) * std::cos(theta) + 2 * width * std::sin(theta);
      line.y2 = height / 2 + row.at(0) * std::sin(theta) - 2 * width * std::cos(theta);
      const std::optional<LineSegment> expected =
          clipToRectangle(line, {-0.5, -0.5, width - 0.5, height - 0.5});
      if (!expected) {
        continue;
      }
      ++golden_lines;
      const auto at = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(next), lines.end(),
                                   [&](const LineSegment& candidate) {
                                     return test::endpointDistance(candidate, *expected) < 1;
                                   });
      if (at != lines.end()) {
        ++near;
        next = static_cast<std::size_t>(at - lines.begin()) + 1;
      }
    }
  }
  EXPECT_GE(static_cast<double>(near), 0.99 * static_cast<double>(golden_lines));
  EXPECT_NEAR(static_cast<double>(found), static_cast<double>(golden_lines),
              0.01 * static_cast<double>(golden_lines));
  RecordProperty("golden_lines", std::to_string(golden_lines));
  RecordProperty("near", std::to_string(near));
  RecordProperty("found", std::to_string(found));
}

}  // namespace
}  // namespace evolin
