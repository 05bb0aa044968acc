// The `evolin` strategy against the published implementation, pair by pair.
#include "evolin_ros/pose/evolin_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evolin_ros/base/error.h"
#include "evolin_ros/metrics/pose_error.h"
#include "test/pose/golden_pairs.h"
#include "test/pose/line_scene.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

constexpr double kRotationTolerance = 0.001;       // degrees
constexpr double kTranslationTolerance = 0.00005;  // metres

void expectPose(const RelativePose& result, const Pose& golden, std::size_t active,
                const std::string& where) {
  ASSERT_TRUE(result.found()) << where << ": " << result.reason;
  const PoseErrors difference =
      poseErrors(golden, result.first_to_second, Protocol::kPaper).value();
  EXPECT_LE(difference.rotation, kRotationTolerance) << where;
  EXPECT_LE(difference.translation, kTranslationTolerance) << where;
  EXPECT_EQ(result.inliers.size(), active) << where;
  EXPECT_EQ(result.ill_conditioned, active < 6) << where;
}

void expectGolden(const test::GoldenPairs& golden) {
  const EvolinPoseEstimator estimator;
  ASSERT_FALSE(golden.pairs.empty());
  for (const test::GoldenPair& pair : golden.pairs) {
    const std::string where = std::to_string(pair.first) + " to " + std::to_string(pair.second);
    expectPose(estimator.estimate(pair.matches, golden.camera), pair.first_to_second,
               pair.forward_active, where);
    expectPose(estimator.estimate(exchanged(pair.matches), golden.camera), pair.second_to_first,
               pair.backward_active, where + " backwards");
  }
}

TEST(EvolinPose, EqualsThePublishedPosesOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  expectGolden(test::goldenLivingRoom());
}

TEST(EvolinPose, EqualsThePublishedPosesOnTheDrawnScene) {
  EVOLIN_REQUIRE_SHARED_DATA();
  expectGolden(test::goldenDrawnScene());
}

Camera camera() { return test::pinhole(500, 510, 320, 240); }

TEST(EvolinPose, FindsASmallMotionOnExactLines) {
  test::RandomLines random(1);
  const Pose truth = test::motionOf({0.01, -0.02, 0.015}, {0.03, -0.02, 0.01});
  const SpatialMatches matches = test::observe(test::randomSegments(40, &random), truth, camera());
  for (const bool normalised : {false, true}) {
    EvolinPoseOptions options;
    options.normalised = normalised;
    const RelativePose result = EvolinPoseEstimator(options).estimate(matches, camera());
    ASSERT_TRUE(result.found()) << result.reason;
    const PoseErrors errors = poseErrors(truth, result.first_to_second, Protocol::kPaper).value();
    EXPECT_LT(errors.rotation, 1e-4);
    EXPECT_LT(errors.translation, 1e-5);
    EXPECT_FALSE(result.ill_conditioned);
    EXPECT_EQ(result.inliers.size(), matches.size());
    EXPECT_TRUE(result.covariance.allFinite());
  }
}

TEST(EvolinPose, NormalisedLinesOutliveTheGates) {
  test::RandomLines random(2);
  const Pose truth = test::motionOf({0.01, -0.02, 0.015}, {0.03, -0.02, 0.01});
  SpatialMatches matches = test::observe(test::randomSegments(60, &random), truth, camera());
  test::addNoise(0.5, camera(), &random, &matches);
  EvolinPoseOptions paper;
  paper.normalised = true;
  const RelativePose published = EvolinPoseEstimator().estimate(matches, camera());
  const RelativePose article = EvolinPoseEstimator(paper).estimate(matches, camera());
  ASSERT_TRUE(published.found() && article.found());
  // Pixel distance times length exceeds 20000 / 50^2 at almost any noise; distance alone does not.
  EXPECT_LT(published.inliers.size(), 10U);
  EXPECT_GT(article.inliers.size(), 50U);
  EXPECT_LT(poseErrors(truth, article.first_to_second, Protocol::kPaper)->rotation, 0.3);
}

TEST(EvolinPose, ReturnsTheIdentityWithoutNansForIdenticalFrames) {
  test::RandomLines random(3);
  const SpatialMatches matches = test::observe(test::randomSegments(20, &random), Pose(), camera());
  const RelativePose result = EvolinPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  const PoseErrors errors = poseErrors({}, result.first_to_second, Protocol::kEvolin).value();
  EXPECT_LT(errors.rotation, 1e-6);
  EXPECT_LT(errors.translation, 1e-8);
}

TEST(EvolinPose, NeedsThreeMatches) {
  test::RandomLines random(4);
  const SpatialMatches three = test::observe(test::randomSegments(3, &random), Pose(), camera());
  const EvolinPoseEstimator estimator;
  const RelativePose found = estimator.estimate(three, camera());
  EXPECT_TRUE(found.found());
  EXPECT_TRUE(found.ill_conditioned);
  const RelativePose none = estimator.estimate({three.begin(), three.begin() + 2}, camera());
  EXPECT_EQ(none.failure, PoseFailure::kTooFewMatches);
  EXPECT_NE(none.reason.find("2 matches"), std::string::npos);
  EXPECT_EQ(estimator.estimate({}, camera()).failure, PoseFailure::kTooFewMatches);
}

TEST(EvolinPose, SaysSoWhenTheNumbersRunAway) {
  test::RandomLines random(5);
  SpatialMatches matches = test::observe(test::randomSegments(10, &random), Pose(), camera());
  matches[2].second.point1.z() = 0;  // projects to infinity
  const RelativePose result = EvolinPoseEstimator().estimate(matches, camera());
  EXPECT_TRUE(result.first_to_second.rotation.coeffs().allFinite());
  EXPECT_TRUE(result.first_to_second.translation.allFinite());
  EXPECT_TRUE(result.found() || result.failure == PoseFailure::kNotFinite);
}

TEST(EvolinPose, IsTheSameEveryTime) {
  test::RandomLines random(6);
  SpatialMatches matches = test::observe(test::randomSegments(40, &random),
                                         test::motionOf({0.01, 0, 0}, {0, 0.05, 0}), camera());
  test::addNoise(1, camera(), &random, &matches);
  const EvolinPoseEstimator estimator;
  const RelativePose once = estimator.estimate(matches, camera());
  const RelativePose again = estimator.estimate(matches, camera());
  EXPECT_EQ(once.inliers, again.inliers);
  EXPECT_EQ(once.iterations, again.iterations);
  EXPECT_EQ((once.first_to_second.translation - again.first_to_second.translation).norm(), 0);
}

TEST(EvolinPose, RefusesOptionsOutOfRange) {
  const auto refuses = [](void (*change)(EvolinPoseOptions*), const std::string& key) {
    EvolinPoseOptions options;
    change(&options);
    test::expectError<ConfigError>([&] { EvolinPoseEstimator estimator(options); }, {key});
  };
  refuses([](EvolinPoseOptions* o) { o->rounds = 0; }, "rounds");
  refuses([](EvolinPoseOptions* o) { o->steps = 0; }, "steps");
  refuses([](EvolinPoseOptions* o) { o->trials = 0; }, "trials");
  refuses([](EvolinPoseOptions* o) { o->huber_delta = 0; }, "huber_delta");
  refuses([](EvolinPoseOptions* o) { o->first_gate = std::nan(""); }, "first_gate");
  refuses([](EvolinPoseOptions* o) { o->min_active = 2; }, "min_active");
}

TEST(PoseStrategy, NamesReadBack) {
  for (const PoseStrategy strategy : {PoseStrategy::kEvolin, PoseStrategy::kRobust}) {
    EXPECT_EQ(parsePoseStrategy(toString(strategy)), strategy);
  }
  test::expectError([] { parsePoseStrategy("ransac"); }, {"ransac", "evolin or robust"});
}

}  // namespace
}  // namespace evolin
