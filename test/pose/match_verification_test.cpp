// Matches against one motion: drawn scenes with wrong matches, holes in the depth, and no motion.
#include "evolin_ros/pose/match_verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "evolin_ros/base/error.h"
#include "test/pose/line_scene.h"

namespace evolin {
namespace {

Camera camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 500;
  camera.fy = -510;  // as ICL-NUIM has it
  camera.cx = 320;
  camera.cy = 240;
  return camera;
}

// Lines of a scene seen in two frames, line i of one being line i of the other.
struct Scene {
  LineSegments lines[2];
  std::vector<std::optional<Segment3d>> in_space[2];

  MatchVerification verify(const LineMatches& matches,
                           const MatchVerificationOptions& options = {}) const {
    return verifyByPose({lines[0], in_space[0]}, {lines[1], in_space[1]}, matches, camera(),
                        options);
  }
};

Scene drawScene(std::size_t count, std::uint64_t seed, double noise = 0) {
  test::RandomLines random(seed);
  SpatialMatches seen =
      test::observe(test::randomSegments(count, &random),
                    test::motionOf({0.02, -0.05, 0.03}, {0.1, -0.05, 0.08}), camera());
  if (noise > 0) {
    test::addNoise(noise, camera(), &random, &seen);
  }
  Scene scene;
  for (const SpatialMatch& match : seen) {
    for (int side = 0; side < 2; ++side) {
      const LiftedLine& lifted = side == 0 ? match.first : match.second;
      LineSegment line;
      line.x1 = lifted.pixel1.x();
      line.y1 = lifted.pixel1.y();
      line.x2 = lifted.pixel2.x();
      line.y2 = lifted.pixel2.y();
      scene.lines[side].push_back(line);
      scene.in_space[side].push_back(Segment3d{lifted.point1, lifted.point2});
    }
  }
  return scene;
}

// Line i with line i, but the first `wrong` of them in turn with each other.
LineMatches matchesOf(std::size_t count, std::size_t wrong) {
  LineMatches matches(count);
  for (std::size_t i = 0; i < count; ++i) {
    matches[i].first = static_cast<std::uint32_t>(i);
    matches[i].second = static_cast<std::uint32_t>(i < wrong ? (i + 1) % wrong : i);
  }
  return matches;
}

std::vector<std::size_t> placesFrom(std::size_t first, std::size_t end) {
  std::vector<std::size_t> places(end - first);
  std::iota(places.begin(), places.end(), first);
  return places;
}

TEST(MatchVerification, KeepsEveryTrueMatch) {
  const MatchVerification result = drawScene(30, 1).verify(matchesOf(30, 0));
  EXPECT_TRUE(result.found()) << toString(result.failure);
  EXPECT_EQ(result.kept, placesFrom(0, 30));
  EXPECT_EQ(result.without_depth, 0U);
}

TEST(MatchVerification, DropsWrongMatchesAndKeepsTrueOnes) {
  const MatchVerification result = drawScene(60, 2, 0.5).verify(matchesOf(60, 25));
  ASSERT_TRUE(result.found()) << toString(result.failure);
  const auto right = std::count_if(result.kept.begin(), result.kept.end(),
                                   [](std::size_t place) { return place >= 25; });
  EXPECT_GE(right, 34);
  EXPECT_LE(static_cast<std::ptrdiff_t>(result.kept.size()) - right, 2)
      << "a wrong match may lie right by chance";
}

TEST(MatchVerification, NeedsDepthInOneFrameOfAMatchOnly) {
  Scene scene = drawScene(40, 3);
  for (std::size_t i = 0; i < 10; ++i) {
    scene.in_space[i % 2][i].reset();
  }
  const MatchVerification result = scene.verify(matchesOf(40, 0));
  EXPECT_EQ(result.kept, placesFrom(0, 40));
  EXPECT_EQ(result.without_depth, 0U);

  const MatchVerification wrong = scene.verify(matchesOf(40, 10));
  ASSERT_TRUE(wrong.found()) << toString(wrong.failure);
  EXPECT_TRUE(std::includes(wrong.kept.begin(), wrong.kept.end(), result.kept.begin() + 10,
                            result.kept.end()));
  EXPECT_LE(wrong.kept.size(), 32U);
}

TEST(MatchVerification, KeepsNoMatchWithoutDepthInEitherFrame) {
  Scene scene = drawScene(30, 4);
  for (std::size_t i = 0; i < 7; ++i) {
    scene.in_space[0][i].reset();
    scene.in_space[1][i].reset();
  }
  const MatchVerification result = scene.verify(matchesOf(30, 0));
  EXPECT_EQ(result.without_depth, 7U);
  EXPECT_EQ(result.kept, placesFrom(7, 30));
}

TEST(MatchVerification, KeepsNothingWhereNoMotionIsFound) {
  const Scene scene = drawScene(40, 5);
  const MatchVerification shuffled = scene.verify(matchesOf(40, 40));
  EXPECT_EQ(shuffled.failure, PoseFailure::kNoConsensus);
  EXPECT_TRUE(shuffled.kept.empty());

  const MatchVerification none = scene.verify({});
  EXPECT_EQ(none.failure, PoseFailure::kTooFewMatches);
  EXPECT_TRUE(none.kept.empty());

  Scene dark = scene;
  dark.in_space[0].assign(40, std::nullopt);
  const MatchVerification blind = dark.verify(matchesOf(40, 0));
  EXPECT_EQ(blind.failure, PoseFailure::kTooFewMatches);
  EXPECT_TRUE(blind.kept.empty());
}

TEST(MatchVerification, AsksForSoManyInliers) {
  const Scene scene = drawScene(12, 6);
  MatchVerificationOptions options;
  options.min_inliers = 12;
  EXPECT_EQ(scene.verify(matchesOf(12, 0), options).kept.size(), 12U);
  options.min_inliers = 13;
  const MatchVerification result = scene.verify(matchesOf(12, 0), options);
  EXPECT_EQ(result.failure, PoseFailure::kNoConsensus);
  EXPECT_TRUE(result.kept.empty());
}

TEST(MatchVerification, IsStricterWithASmallerThreshold) {
  const Scene scene = drawScene(60, 7, 1.0);
  MatchVerificationOptions options;
  std::size_t last = 61;
  for (const double threshold : {10.0, 1.5, 0.7}) {
    options.threshold = threshold;
    const MatchVerification result = scene.verify(matchesOf(60, 0), options);
    ASSERT_TRUE(result.found()) << threshold << ": " << toString(result.failure);
    EXPECT_LT(result.kept.size(), last) << threshold;
    last = result.kept.size();
  }
}

TEST(MatchVerification, IsTheSameForTheSameInput) {
  const Scene scene = drawScene(60, 8, 0.5);
  EXPECT_EQ(scene.verify(matchesOf(60, 20)).kept, scene.verify(matchesOf(60, 20)).kept);
}

TEST(MatchVerification, RefusesWhatCannotBe) {
  const Scene scene = drawScene(5, 9);
  LineMatches beyond(1);
  beyond[0].second = 5;
  EXPECT_THROW(scene.verify(beyond), Error);
  MatchVerificationOptions options;
  options.min_inliers = 2;
  EXPECT_THROW(scene.verify({}, options), ConfigError);
  for (const double threshold : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()}) {
    options = {};
    options.threshold = threshold;
    EXPECT_THROW(scene.verify({}, options), ConfigError) << threshold;
  }
  Scene short_of_one = scene;
  short_of_one.in_space[1].pop_back();
  EXPECT_THROW(short_of_one.verify({}), Error);
}

}  // namespace
}  // namespace evolin
