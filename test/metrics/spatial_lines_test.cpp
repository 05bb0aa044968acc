// Lines lifted into space and projected, by the rules of both protocols.
#include "evolin_ros/metrics/spatial_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/metrics/spatial_support.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::segment;
using test::wallFrame;

TEST(LiftLines, KeepsEveryLineInItsRow) {
  const LineSegments lines = {segment(10, 10, 50, 30), segment(5, 5, 5, 5),
                              segment(10, 20, 50, 20)};
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const SpatialFrame frame = wallFrame(protocol, lines);
    ASSERT_EQ(frame.lines.size(), 3U);
    for (const SpatialLine& line : frame.lines) {
      EXPECT_TRUE(line.in_image);
      EXPECT_TRUE(line.endpoints.has_value());
    }
  }
}

TEST(LiftLines, EvolinClampsAndPaperClips) {
  const LineSegments lines = {segment(-20, 20, 40, 80), segment(-9, 200, -5, 300)};
  const SpatialFrame evolin = wallFrame(Protocol::kEvolin, lines);
  EXPECT_EQ(evolin.lines[0].segment.y1, 20);
  EXPECT_EQ(evolin.lines[0].segment.x1, 0);
  EXPECT_TRUE(evolin.lines[1].in_image);
  EXPECT_EQ(evolin.lines[1].segment.y2, 127);
  const SpatialFrame paper = wallFrame(Protocol::kPaper, lines);
  EXPECT_EQ(paper.lines[0].segment.y1, 40);
  EXPECT_EQ(paper.lines[0].segment.x1, 0);
  EXPECT_FALSE(paper.lines[1].in_image);
  EXPECT_FALSE(paper.lines[1].endpoints.has_value());
}

TEST(LiftLines, LinesWithoutDepthStayWithoutEndpoints) {
  const SpatialFrame frame = test::halfWallFrame(
      Protocol::kEvolin, {segment(10, 10, 50, 30), segment(10, 10, 90, 30)}, 64);
  EXPECT_TRUE(frame.lines[0].endpoints.has_value());
  EXPECT_FALSE(frame.lines[1].endpoints.has_value());
}

TEST(LiftLines, NamesFrameAndRowOfBadLines) {
  test::expectError(
      [] {
        wallFrame(Protocol::kEvolin, {segment(1, 1, 2, 2), segment(1, std::nan(""), 2, 2)});
      },
      {"wall", "row 1", "1,nan,2,2"});
  Camera camera = test::wallCamera();
  camera.fy = 0;
  test::expectError(
      [&camera] {
        liftLines(Protocol::kPaper, "0007", {}, DepthMap(test::wallDepth()), camera, Pose());
      },
      {"0007", "128 and 0"});
}

TEST(ProjectLines, ShiftsWithTheCamera) {
  const SpatialFrame first = wallFrame(Protocol::kEvolin, {segment(30, 10, 50, 30)});
  const SpatialFrame second = wallFrame(Protocol::kEvolin, {}, 7);
  const auto projections = projectLines(first, second);
  ASSERT_EQ(projections.size(), 1U);
  EXPECT_NEAR(projections[0].segment.x1, 23, 1e-9);
  EXPECT_NEAR(projections[0].segment.x2, 43, 1e-9);
  EXPECT_NEAR(projections[0].segment.y2, 30, 1e-9);
}

TEST(ProjectLines, EvolinProjectsRoundedEndpointsAndPaperTheEndpointsThemselves) {
  const LineSegments lines = {segment(30.4, 10.5, 50.6, 31.5)};
  const auto evolin =
      projectLines(wallFrame(Protocol::kEvolin, lines), wallFrame(Protocol::kEvolin, {}, 7));
  ASSERT_EQ(evolin.size(), 1U);
  EXPECT_NEAR(evolin[0].segment.x1, 23, 1e-9);
  EXPECT_NEAR(evolin[0].segment.y1, 10, 1e-9);
  EXPECT_NEAR(evolin[0].segment.x2, 44, 1e-9);
  EXPECT_NEAR(evolin[0].segment.y2, 32, 1e-9);
  const auto paper =
      projectLines(wallFrame(Protocol::kPaper, lines), wallFrame(Protocol::kPaper, {}, 7));
  ASSERT_EQ(paper.size(), 1U);
  EXPECT_NEAR(paper[0].segment.x1, 23.4, 1e-9);
  EXPECT_NEAR(paper[0].segment.y1, 10.5, 1e-9);
}

TEST(ProjectLines, EvolinDropsAxisParallelOnesAfterClampingAndPaperKeepsThem) {
  // The first leaves the image altogether: clamped it is a vertical piece of the border. The second
  // is horizontal already; the third stays.
  const LineSegments lines = {segment(3, 10, 5, 30), segment(30, 64, 90, 64),
                              segment(30, 60, 90, 70)};
  const auto evolin =
      projectLines(wallFrame(Protocol::kEvolin, lines), wallFrame(Protocol::kEvolin, {}, 20));
  ASSERT_EQ(evolin.size(), 1U);
  EXPECT_EQ(evolin[0].row, 2U);
  const auto paper =
      projectLines(wallFrame(Protocol::kPaper, lines), wallFrame(Protocol::kPaper, {}, 20));
  ASSERT_EQ(paper.size(), 2U);
  EXPECT_EQ(paper[0].row, 1U);
  EXPECT_EQ(paper[1].row, 2U);
}

TEST(ProjectLines, BothDropPoints) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    EXPECT_TRUE(
        projectLines(wallFrame(protocol, {segment(30, 30, 30, 30)}), wallFrame(protocol, {}, 7))
            .empty());
  }
}

TEST(ProjectLines, BehindTheCameraEvolinMirrorsAndPaperDrops) {
  // The second camera stands behind the wall and looks on.
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    Pose beyond;
    beyond.translation.z() = 2 * test::kWallDepth;
    const SpatialFrame second =
        liftLines(protocol, "beyond", {}, DepthMap(test::wallDepth()), test::wallCamera(), beyond);
    const auto projections = projectLines(wallFrame(protocol, {segment(60, 50, 80, 70)}), second);
    ASSERT_EQ(projections.size(), protocol == Protocol::kEvolin ? 1U : 0U);
    if (protocol == Protocol::kEvolin) {
      EXPECT_NEAR(projections[0].segment.x1, 68, 1e-9);
      EXPECT_NEAR(projections[0].segment.y2, 58, 1e-9);
    }
  }
}

TEST(ProjectLines, TakesTheSizeOfTheFrameThatItProjectsInto) {
  const SpatialFrame first = wallFrame(Protocol::kEvolin, {segment(30, 10, 90, 30)});
  const SpatialFrame narrow =
      liftLines(Protocol::kEvolin, "narrow", {},
                DepthMap(cv::Mat(128, 64, CV_32FC1, cv::Scalar(1))), test::wallCamera(), Pose());
  const auto projections = projectLines(first, narrow);
  ASSERT_EQ(projections.size(), 1U);
  EXPECT_EQ(projections[0].segment.x2, 63);
}

TEST(ProjectLines, RefusesFramesOfDifferentProtocols) {
  test::expectError(
      [] { projectLines(wallFrame(Protocol::kEvolin, {}), wallFrame(Protocol::kPaper, {})); },
      {"evolin", "paper"});
}

}  // namespace
}  // namespace evolin
