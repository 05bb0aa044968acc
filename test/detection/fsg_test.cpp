// fsg and its grouping against hand-made segments and the golden figures.
#include "evolin_ros/detection/fsg.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "fsg_grouping.h"
#include "lsd_lines.h"
#include "test/detection/own_detectors.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

class FsgTest : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Fsg detector_;
};

/// Groups the segments that a golden folder holds for each frame in turn.
class GoldenGrouping : public LineDetector {
 public:
  void configure(const YAML::Node&) override {}
  LineSegments detect(const Frame& frame) override {
    return grouping_.run(
        readLinesCsv(test::goldenFolder() / "fsg_lsd_input" / "lines" / (frame.name + ".csv")),
        frame.image.size());
  }

 private:
  fsg::Grouping grouping_{FsgParameters()};
};

/// FSG's first stage.
class Segments : public LineDetector {
 public:
  void configure(const YAML::Node&) override {}
  LineSegments detect(const Frame& frame) override { return finder_.find(frame.image); }

 private:
  static LsdParameters standard() {
    LsdParameters parameters;
    parameters.refine = "standard";
    return parameters;
  }
  lsd::LineFinder finder_{standard(), {lsd::SeedOrder::kRows, false}};
};

TEST_F(FsgTest, NamesWhatIsWrongWithAParameter) {
  Fsg fresh;
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{max_gaps: 3}")); },
                                 {"detector fsg", "max_gaps", "max_gap"});
  test::expectError<ConfigError>([&] { fresh.configure(YAML::Load("{orientation_bins: 2}")); },
                                 {"orientation_bins", "3"});
}

TEST_F(FsgTest, ExtremeParametersWork) {
  test::expectExtremeParametersWork<Fsg>(
      {"{endpoint_error: 100}", "{endpoint_error: 0.5}", "{max_overlap: 1, max_gap: 1000}",
       "{orientation_bins: 3, length_bins: 1}", "{segment_density: 1}",
       "{segment_density: 1000000}", "{min_line_length: 0}"});
}

TEST(FsgGrouping, JoinsPiecesOfOneLine) {
  fsg::Grouping grouping{FsgParameters()};
  const LineSegments pieces = {
      {100, 100, 180, 100}, {190, 100.4, 240, 100.6}, {300, 101, 250, 100.7}};
  const LineSegments lines = grouping.run(pieces, {640, 480});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].length(), 200, 0.1);
  EXPECT_NEAR(std::min(lines[0].x1, lines[0].x2), 100, 0.1);
  EXPECT_NEAR(std::max(lines[0].x1, lines[0].x2), 300, 0.1);
}

TEST(FsgGrouping, KeepsApartWhatLiesBesideOrAcross) {
  fsg::Grouping grouping{FsgParameters()};
  // A parallel, a perpendicular, and one that is collinear but turned too far.
  const LineSegments pieces = {
      {100, 100, 200, 100}, {100, 110, 200, 110}, {210, 60, 210, 140}, {230, 100, 300, 120}};
  EXPECT_EQ(grouping.run(pieces, {640, 480}).size(), 4U);
}

TEST(FsgGrouping, DropsShortSegmentsThatStayAlone) {
  fsg::Grouping grouping{FsgParameters()};
  const LineSegments lines =
      grouping.run({{100, 100, 129, 100}, {100, 300, 131, 300}, {5, 5, 5, 8}}, {640, 480});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].y1, 300);
}

// Middles at m across a strip of width w: a segment of length l is inside when its angle to the
// strip is at most asin(2 min(m, w - m) / l) to either side.
TEST(FsgValidity, ChanceOfLyingInAStrip) {
  for (const double width : {0.5, 3.0, 10.0, 40.0}) {
    for (const double length : {2.0, 10.0, 19.0, 35.0, 100.0}) {
      constexpr int kSteps = 200000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double x = width * (i + 0.5) / kSteps;
        sum += std::asin(std::min(1.0, (width + x) / length)) +
               std::asin(std::min(1.0, (width - x) / length));
      }
      const double expected = sum * width / kSteps / CV_PI;
      EXPECT_NEAR(fsg::insideStrip(width, length), expected, 1e-4 * expected + 1e-9)
          << width << " " << length;
    }
  }
}

TEST_F(FsgTest, GroupingEqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  GoldenGrouping grouping;
  const test::GoldenAgreement agreement = test::compareWithGolden(&grouping, "fsg", -1);
  EXPECT_GE(agreement.nearShare(), 0.99);
  EXPECT_EQ(agreement.found, agreement.golden);
}

TEST_F(FsgTest, SegmentsEqualTheGoldenOnes) {
  EVOLIN_REQUIRE_SHARED_DATA();
  Segments segments;
  const test::GoldenAgreement agreement = test::compareWithGolden(&segments, "fsg_lsd_input", -1);
  EXPECT_GE(agreement.nearShare(), 0.97);
}

TEST_F(FsgTest, EqualsTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  test::expectNearGolden(&detector_, "fsg", 0.95, 0.02);
}

}  // namespace
}  // namespace evolin
