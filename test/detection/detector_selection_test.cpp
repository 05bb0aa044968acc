// The selection of lines that our own detectors offer.
#include "evolin_ros/detection/detector_selection.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

LineSegments someLines() { return {{1, 1, 11, 1, 5}, {20, 5, 25, 5, 9}, {4, 8, 4, 18, 2}}; }

TEST(LineFilter, KeepsAllByDefault) {
  EXPECT_EQ(LineFilter(DetectorSelection()).apply(someLines(), {30, 20}, "test").size(), 3U);
}

TEST(LineFilter, SelectsByScoreLengthAndNumber) {
  DetectorSelection selection;
  selection.score_threshold = 2;
  EXPECT_EQ(LineFilter(selection).apply(someLines(), {30, 20}, "test").size(), 2U);
  selection = {};
  selection.min_length = 6;
  EXPECT_EQ(LineFilter(selection).apply(someLines(), {30, 20}, "test").size(), 2U);
  selection = {};
  selection.max_lines = 1;
  const LineSegments best = LineFilter(selection).apply(someLines(), {30, 20}, "test");
  ASSERT_EQ(best.size(), 1U);
  EXPECT_EQ(best[0].score, 9);
}

TEST(LineFilter, CutsLinesAtTheEdgeOfTheImage) {
  const LineSegments lines = LineFilter().apply(
      {{-3, 4, 10, 4, 1}, {5, 19.2, 5, 25, 2}, {40, 3, 50, 3, 3}, {2, 2, 2, 2, 4}}, {30, 20},
      "test");
  ASSERT_EQ(lines.size(), 2U) << "one outside and one of no length go";
  EXPECT_EQ(lines[0].x1, -0.5);
  EXPECT_EQ(lines[0].x2, 10);
  EXPECT_EQ(lines[1].y2, 19.5);
  EXPECT_EQ(lines[1].score, 2);
}

TEST(LineFilter, KeepsLinesWhoseMiddleIsInTheMask) {
  const test::TemporaryFolder folder;
  cv::Mat mask(20, 30, CV_8UC1, cv::Scalar(0));
  mask.colRange(0, 10).setTo(1);
  DetectorSelection selection;
  selection.mask = (folder.path() / "mask.png").string();
  cv::imwrite(selection.mask, mask);
  const LineFilter filter(selection);
  const LineSegments lines = filter.apply(someLines(), {30, 20}, "test");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].score, 5);
  EXPECT_EQ(lines[1].score, 2);
  test::expectError(
      [&] {
        filter.apply(someLines(), {31, 20}, "detector x");
      },
      {"detector x", selection.mask, "30x20", "31x20"});
}

TEST(LineFilter, NamesAMaskThatIsNoImage) {
  DetectorSelection selection;
  selection.mask = "/nonexistent/mask.png";
  test::expectError([&] { LineFilter{selection}; }, {"/nonexistent/mask.png"});
}

TEST(ReadSelection, ReadsEachParameterAndRefusesOthers) {
  DetectorSelection selection;
  ParameterReader reader(
      YAML::Load("{score_threshold: 3.5, min_length: 12, max_lines: 7, mask: a.png}"), "test");
  readSelection(&reader, &selection);
  reader.finish();
  EXPECT_EQ(selection.score_threshold, 3.5);
  EXPECT_EQ(selection.min_length, 12);
  EXPECT_EQ(selection.max_lines, 7);
  EXPECT_EQ(selection.mask, "a.png");
  ParameterReader negative(YAML::Load("{max_lines: -1}"), "test");
  test::expectError<ConfigError>([&] { readSelection(&negative, &selection); },
                                 {"max_lines", "-1"});
}

}  // namespace
}  // namespace evolin
