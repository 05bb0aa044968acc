// Lifting of matched segments by depth, checked by hand and against the published solver's inputs.
#include "evolin_ros/pose/matched_lines.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "evolin_ros/dataset/csv.h"
#include "test/pose/golden_pairs.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

Camera camera() {
  Camera camera;
  camera.fx = 10;
  camera.fy = -20;
  camera.cx = 4;
  camera.cy = 3;
  return camera;
}

/// 10 x 8 pixels, 2 m everywhere.
cv::Mat flatImage() { return cv::Mat(8, 10, CV_16UC1, cv::Scalar(2000)); }

DepthMap flat() { return DepthMap(flatImage(), 1000); }

SpatialMatches liftAll(const LineSegments& first, const DepthMap& first_depth,
                       const LineSegments& second, const DepthMap& second_depth,
                       const IndexPairs& matches, const Camera& camera, EndpointRule rule) {
  return liftedMatches(liftEndpoints("1", first, first_depth, camera, rule),
                       liftEndpoints("2", second, second_depth, camera, rule), matches);
}

SpatialMatches liftOne(const LineSegment& line, const DepthMap& depth, EndpointRule rule) {
  return liftAll({line}, depth, {line}, depth, {{0, 0}}, camera(), rule);
}

TEST(MatchedLines, TruncatesClampedEndpoints) {
  const SpatialMatches lifted = liftOne({6.9, 1.9, 12.5, -3}, flat(), EndpointRule::kTruncated);
  ASSERT_EQ(lifted.size(), 1U);
  const LiftedLine& line = lifted[0].first;
  EXPECT_EQ(line.pixel1, Eigen::Vector2d(6, 1));
  EXPECT_EQ(line.pixel2, Eigen::Vector2d(9, 0));
  EXPECT_LT((line.point1 - Eigen::Vector3d(0.4, 0.2, 2)).norm(), 1e-12);
  EXPECT_LT((line.point2 - Eigen::Vector3d(1, 0.3, 2)).norm(), 1e-12);
}

TEST(MatchedLines, KeepsExactEndpointsAndCutsAtTheBorder) {
  const SpatialMatches lifted = liftOne({6.9, 1.5, 12.9, 7.5}, flat(), EndpointRule::kExact);
  ASSERT_EQ(lifted.size(), 1U);
  const LiftedLine& line = lifted[0].second;
  EXPECT_EQ(line.pixel1, Eigen::Vector2d(6.9, 1.5));
  EXPECT_LT((line.pixel2 - Eigen::Vector2d(9, 3.6)).norm(), 1e-12);
  EXPECT_LT((line.point1 - Eigen::Vector3d(0.58, 0.15, 2)).norm(), 1e-12);
}

TEST(MatchedLines, TakesTheDepthOfTheRightPixel) {
  cv::Mat image = flatImage();
  image.at<std::uint16_t>(2, 7) = 3000;
  const DepthMap depth(image, 1000);
  const LineSegment line{6.6, 1.6, 1, 1};
  EXPECT_EQ(liftOne(line, depth, EndpointRule::kTruncated)[0].first.point1.z(), 2);
  EXPECT_EQ(liftOne(line, depth, EndpointRule::kExact)[0].first.point1.z(), 3);
}

TEST(MatchedLines, ReadsMetresToo) {
  cv::Mat image(8, 10, CV_32FC1, cv::Scalar(1.5));
  const DepthMap metres(image);
  EXPECT_EQ(liftOne({1, 1, 5, 5}, metres, EndpointRule::kTruncated)[0].first.point1.z(), 1.5);
  image.at<float>(5, 5) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(liftOne({1, 1, 5, 5}, metres, EndpointRule::kTruncated).empty());
}

TEST(MatchedLines, DropsMatchesWithoutDepthAtAnyEnd) {
  const LineSegment line{1, 1, 5, 5};
  const LineSegment other{2, 6, 8, 2};
  for (const auto& [x, y] : {std::pair{1, 1}, std::pair{5, 5}}) {
    cv::Mat image = flatImage();
    image.at<std::uint16_t>(y, x) = 0;
    const DepthMap holed(image, 1000);
    for (const bool in_first : {true, false}) {
      const SpatialMatches lifted =
          liftAll({line, other}, in_first ? holed : flat(), {other, line},
                  in_first ? flat() : holed, {{0, 1}, {1, 0}}, camera(), EndpointRule::kTruncated);
      ASSERT_EQ(lifted.size(), 1U);
      EXPECT_EQ(lifted[0].match, 1U);
    }
  }
}

TEST(MatchedLines, ExactlyDropsWhatIsOutsideTheImage) {
  const LineSegment outside{20, 20, 30, 25};
  EXPECT_TRUE(liftOne(outside, flat(), EndpointRule::kExact).empty());
  EXPECT_EQ(liftOne(outside, flat(), EndpointRule::kTruncated).size(), 1U);
}

TEST(MatchedLines, ExchangeOfFramesIsItsOwnInverse) {
  const DepthMap depth = flat();
  const SpatialMatches lifted = liftAll({{1, 1, 5, 5}}, depth, {{2, 1, 6, 5}}, depth, {{0, 0}},
                                        camera(), EndpointRule::kExact);
  EXPECT_EQ(exchanged(lifted)[0].first.pixel1, Eigen::Vector2d(2, 1));
  EXPECT_EQ(exchanged(exchanged(lifted))[0].first.pixel1, Eigen::Vector2d(1, 1));
}

TEST(MatchedLines, RefusesWhatCannotBeLifted) {
  const LineSegments lines = {{1, 1, 5, 5}};
  const auto lift = [&](const LineSegments& first, const DepthMap& depth, const IndexPairs& matches,
                        const Camera& pinhole) {
    liftAll(first, depth, lines, flat(), matches, pinhole, EndpointRule::kExact);
  };
  test::expectError(
      [&] {
        lift(lines, flat(), {{0, 0}, {1, 0}}, camera());
      },
      {"match 1", "line 1", "first"});
  test::expectError([&] { lift(lines, flat(), {{0, 7}}, camera()); }, {"line 7", "second"});
  test::expectError([&] { lift(lines, flat(), {{-1, 0}}, camera()); }, {"line -1"});
  test::expectError(
      [&] {
        lift({{1, 1, std::nan(""), 5}}, flat(), {{0, 0}}, camera());
      },
      {"not finite"});
  Camera blind = camera();
  blind.fx = 0;
  test::expectError([&] { lift(lines, flat(), {{0, 0}}, blind); }, {"fx"});
}

void expectLine(const LiftedLine& line, const LiftedLine& golden, const std::string& where) {
  EXPECT_EQ(line.pixel1, golden.pixel1) << where;
  EXPECT_EQ(line.pixel2, golden.pixel2) << where;
  EXPECT_LT((line.point1 - golden.point1).norm(), 1e-12) << where;
  EXPECT_LT((line.point2 - golden.point2).norm(), 1e-12) << where;
}

void expectGoldenInputs(const std::filesystem::path& folder, const std::string& lines,
                        const std::string& associations, const test::GoldenPairs& golden) {
  const auto frame = [&](int index) {
    const std::string stem = "000" + std::to_string(index);
    return std::pair{
        readLinesCsv(folder / lines / (stem + ".csv")),
        DepthMap(cv::imread((folder / "depth" / (stem + ".png")).string(), cv::IMREAD_UNCHANGED),
                 5000)};
  };
  for (const test::GoldenPair& pair : golden.pairs) {
    const auto [first, first_depth] = frame(pair.first);
    const auto [second, second_depth] = frame(pair.second);
    const std::string stem =
        "000" + std::to_string(pair.first) + "_000" + std::to_string(pair.second);
    const SpatialMatches lifted =
        liftAll(first, first_depth, second, second_depth,
                readIndexPairsCsv(folder / associations / (stem + ".csv")), golden.camera,
                EndpointRule::kTruncated);
    ASSERT_EQ(lifted.size(), pair.matches.size()) << stem;
    for (std::size_t i = 0; i < lifted.size(); ++i) {
      expectLine(lifted[i].first, pair.matches[i].first, stem);
      expectLine(lifted[i].second, pair.matches[i].second, stem);
    }
  }
}

TEST(MatchedLines, AreThePublishedSolversInputs) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path data = test::sharedFolder() / "data";
  expectGoldenInputs(data / "icl_nuim_lr_sample", "gt_lines", "gt_associations_step1",
                     test::goldenLivingRoom());
  expectGoldenInputs(data / "golden/sets/pose_basic", "lines", "associations",
                     test::goldenDrawnScene());
}

}  // namespace
}  // namespace evolin
