// The `robust` strategy on drawn scenes: right where there is an answer, refused where there is
// none.
#include "evolin_ros/pose/robust_pose.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "evolin_ros/metrics/pose_error.h"
#include "test/pose/line_scene.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::Segment3;

Camera camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 500;
  camera.fy = 510;
  camera.cx = 320;
  camera.cy = 240;
  return camera;
}

const Pose& someMotion() {
  static const Pose kMotion = test::motionOf({0.1, -0.2, 0.15}, {0.3, -0.1, 0.2});
  return kMotion;
}

PoseErrors errorsOf(const RelativePose& result, const Pose& truth) {
  return poseErrors(truth, result.first_to_second, Protocol::kPaper).value();
}

void expectSame(const RelativePose& a, const RelativePose& b) {
  EXPECT_EQ(a.failure, b.failure);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ((a.first_to_second.rotation.coeffs() - b.first_to_second.rotation.coeffs()).norm(), 0);
  EXPECT_EQ((a.first_to_second.translation - b.first_to_second.translation).norm(), 0);
}

TEST(RobustPose, IsExactOnExactLines) {
  test::RandomLines random(1);
  const SpatialMatches matches =
      test::observe(test::randomSegments(20, &random), someMotion(), camera());
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  const PoseErrors errors = errorsOf(result, someMotion());
  EXPECT_LT(errors.rotation, 1e-6);
  EXPECT_LT(errors.translation, 1e-8);
  EXPECT_EQ(result.inliers.size(), matches.size());
  EXPECT_FALSE(result.ill_conditioned);
}

TEST(RobustPose, NeedsNoMoreThanThreeLines) {
  test::RandomLines random(2);
  const SpatialMatches matches =
      test::observe(test::randomSegments(3, &random), someMotion(), camera());
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_LT(errorsOf(result, someMotion()).translation, 1e-6);
  EXPECT_TRUE(result.ill_conditioned);
}

TEST(RobustPose, TakesEndpointsInEitherOrder) {
  test::RandomLines random(3);
  SpatialMatches matches = test::observe(test::randomSegments(20, &random), someMotion(), camera());
  for (std::size_t i = 0; i < matches.size(); i += 2) {
    std::swap(matches[i].second.pixel1, matches[i].second.pixel2);
    std::swap(matches[i].second.point1, matches[i].second.point2);
  }
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_LT(errorsOf(result, someMotion()).rotation, 1e-6);
}

TEST(RobustPose, WorksWithAnUpwardImageAxis) {
  Camera upward = camera();
  upward.fy = -upward.fy;
  test::RandomLines random(4);
  const SpatialMatches matches =
      test::observe(test::randomSegments(20, &random), someMotion(), upward);
  const RelativePose result = RobustPoseEstimator().estimate(matches, upward);
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_LT(errorsOf(result, someMotion()).rotation, 1e-6);
}

TEST(RobustPose, ReturnsTheIdentityWithoutNansForIdenticalFrames) {
  test::RandomLines random(5);
  const SpatialMatches matches = test::observe(test::randomSegments(20, &random), Pose(), camera());
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_TRUE(result.first_to_second.rotation.coeffs().allFinite());
  EXPECT_LT(errorsOf(result, Pose()).rotation, 1e-7);
  EXPECT_LT(errorsOf(result, Pose()).translation, 1e-9);
  EXPECT_TRUE(result.covariance.allFinite());
}

TEST(RobustPose, GivesTheInverseForExchangedFrames) {
  test::RandomLines random(6);
  SpatialMatches matches = test::observe(test::randomSegments(40, &random), someMotion(), camera());
  test::addNoise(1, camera(), &random, &matches);
  test::makeWrong(0.3, &random, &matches);
  const RobustPoseEstimator estimator;
  const RelativePose forward = estimator.estimate(matches, camera());
  const RelativePose backward = estimator.estimate(exchanged(matches), camera());
  ASSERT_TRUE(forward.found() && backward.found());
  Pose product;
  product.rotation = forward.first_to_second.rotation * backward.first_to_second.rotation;
  product.translation = forward.first_to_second.rotation * backward.first_to_second.translation +
                        forward.first_to_second.translation;
  EXPECT_LT(errorsOf({}, product).rotation, 0.01);
  EXPECT_LT(errorsOf({}, product).translation, 1e-3);
}

TEST(RobustPose, FindsTheRightMatches) {
  const RobustPoseEstimator estimator;
  for (std::uint64_t seed = 10; seed < 20; ++seed) {
    test::RandomLines random(seed);
    SpatialMatches matches =
        test::observe(test::randomSegments(50, &random), someMotion(), camera());
    test::addNoise(0.5, camera(), &random, &matches);
    const std::vector<bool> wrong = test::makeWrong(0.5, &random, &matches);
    const RelativePose result = estimator.estimate(matches, camera());
    ASSERT_TRUE(result.found()) << seed << ": " << result.reason;
    std::size_t right = 0;
    for (const std::size_t place : result.inliers) {
      right += wrong[place] ? 0 : 1;
    }
    EXPECT_GE(right, 23U) << seed;
    EXPECT_LE(result.inliers.size() - right, 1U) << seed;
  }
}

TEST(RobustPose, IsTheSameForTheSameSeed) {
  test::RandomLines random(7);
  SpatialMatches matches = test::observe(test::randomSegments(40, &random), someMotion(), camera());
  test::addNoise(1, camera(), &random, &matches);
  test::makeWrong(0.5, &random, &matches);
  RobustPoseOptions options;
  options.seed = 99;
  const RobustPoseEstimator estimator(options);
  const RelativePose once = estimator.estimate(matches, camera());
  expectSame(once, estimator.estimate(matches, camera()));
  expectSame(once, RobustPoseEstimator(options).estimate(matches, camera()));
}

TEST(RobustPose, CovarianceForetellsTheSpread) {
  test::RandomLines random(8);
  const SpatialMatches exact =
      test::observe(test::randomSegments(40, &random), someMotion(), camera());
  Matrix6d foretold = Matrix6d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  constexpr int kRepeats = 200;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    SpatialMatches noisy = exact;
    test::addNoise(0.5, camera(), &random, &noisy);
    const RelativePose result = RobustPoseEstimator().estimate(noisy, camera());
    ASSERT_TRUE(result.found()) << result.reason;
    // exp(d) T: the translation part at the origin of the second camera, to first order.
    const Eigen::Quaterniond turn =
        someMotion().rotation * result.first_to_second.rotation.conjugate();
    const Eigen::Vector3d shift =
        someMotion().translation - turn * result.first_to_second.translation;
    squares += shift.cwiseAbs2();
    foretold += result.covariance;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = squares[axis] / foretold(3 + axis, 3 + axis);
    EXPECT_GT(ratio, 0.5) << "axis " << axis;
    // The two directions share their noise, which counts it as if it were twice as much data.
    EXPECT_LT(ratio, 3) << "axis " << axis;
  }
}

// ---- sets that determine no motion
// ---------------------------------------------------------------

/// Every set is tried as it is and with noise; none may come back as found.
void expectRefused(const std::vector<Segment3>& segments, PoseFailure failure,
                   const Pose& motion = someMotion()) {
  for (const double noise : {0.0, 0.5, 1.0}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      test::RandomLines random(seed);
      SpatialMatches matches = test::observe(segments, motion, camera());
      test::addNoise(noise, camera(), &random, &matches);
      const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
      EXPECT_EQ(result.failure, failure)
          << "noise " << noise << ", seed " << seed << ": " << result.reason;
      EXPECT_FALSE(result.reason.empty());
      EXPECT_TRUE(result.inliers.empty());
    }
  }
}

std::vector<Segment3> parallelSegments(std::size_t count) {
  test::RandomLines random(21);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, 1, 0.2).normalized();
  std::vector<Segment3> segments(count);
  for (Segment3& segment : segments) {
    const double z = random.uniform(2, 5);
    const Eigen::Vector3d middle(random.uniform(-0.4, 0.4) * z, random.uniform(-0.1, 0.1) * z, z);
    const double half = random.uniform(0.3, 0.6);
    segment = {middle - half * direction, middle + half * direction};
  }
  return segments;
}

TEST(RobustPose, RefusesFewerThanThreeLines) {
  expectRefused({}, PoseFailure::kTooFewMatches);
  test::RandomLines random(20);
  expectRefused(test::randomSegments(2, &random), PoseFailure::kTooFewMatches);
}

TEST(RobustPose, RefusesParallelLines) {
  expectRefused(parallelSegments(3), PoseFailure::kDegenerate);
  expectRefused(parallelSegments(30), PoseFailure::kDegenerate);
}

TEST(RobustPose, MarksAMotionThatHangsOnASingleLine) {
  std::vector<Segment3> segments = parallelSegments(30);
  segments.push_back({{-0.8, 0.1, 3}, {0.7, 0.2, 3.2}});
  const SpatialMatches matches = test::observe(segments, someMotion(), camera());
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_TRUE(result.ill_conditioned);
  EXPECT_LT((result.first_to_second.translation - someMotion().translation).norm(), 1e-3);

  // A second line of that kind is enough.
  segments.push_back({{-0.6, -0.3, 2.5}, {0.8, -0.2, 2.8}});
  segments.push_back({{-0.5, 0.4, 3.5}, {0.9, 0.3, 3.1}});
  const RelativePose sure =
      RobustPoseEstimator().estimate(test::observe(segments, someMotion(), camera()), camera());
  ASSERT_TRUE(sure.found()) << sure.reason;
  EXPECT_FALSE(sure.ill_conditioned);
}

TEST(RobustPose, NeverTrustsParallelLinesWithWrongOthers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::RandomLines random(seed);
    std::vector<Segment3> segments = parallelSegments(20);
    for (const Segment3& other : test::randomSegments(20, &random)) {
      segments.push_back(other);
    }
    SpatialMatches matches = test::observe(segments, someMotion(), camera());
    // All of the others are wrong.
    SpatialMatches others(matches.begin() + 20, matches.end());
    test::makeWrong(1, &random, &others);
    std::copy(others.begin(), others.end(), matches.begin() + 20);
    test::addNoise(0.5, camera(), &random, &matches);
    const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
    EXPECT_TRUE(!result.found() || result.ill_conditioned) << seed;
  }
}

const Eigen::Vector3d& meetingPoint() {
  static const Eigen::Vector3d kPoint(0.1, -0.2, 3);
  return kPoint;
}

std::vector<Segment3> segmentsThroughOnePoint() {
  test::RandomLines random(22);
  std::vector<Segment3> segments(20);
  for (Segment3& segment : segments) {
    const Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-1, 1),
                                    random.uniform(-1, 1));
    segment = {meetingPoint() + 0.2 * direction, meetingPoint() + 0.9 * direction};
  }
  return segments;
}

// Both cameras see the point in one direction, along which nothing tells where it is.
TEST(RobustPose, RefusesLinesThroughOnePoint) {
  Pose motion = someMotion();
  motion.translation = motion.rotation * (-0.1 * meetingPoint());
  expectRefused(segmentsThroughOnePoint(), PoseFailure::kDegenerate, motion);
  motion.translation = {0.005, 0.01, 0};
  expectRefused(segmentsThroughOnePoint(), PoseFailure::kDegenerate, motion);
}

TEST(RobustPose, TrustsLinesThroughOnePointOnlyWhereTheBaselineTells) {
  for (const double noise : {0.0, 0.5, 1.0}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      test::RandomLines random(seed);
      SpatialMatches matches = test::observe(segmentsThroughOnePoint(), someMotion(), camera());
      test::addNoise(noise, camera(), &random, &matches);
      const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
      if (noise == 0) {
        EXPECT_TRUE(result.found()) << result.reason;
      }
      if (result.found()) {
        EXPECT_LT(errorsOf(result, someMotion()).translation, 0.1) << noise << ", seed " << seed;
        EXPECT_LT(errorsOf(result, someMotion()).rotation, 1.5) << noise << ", seed " << seed;
      }
    }
  }
}

TEST(RobustPose, RefusesLinesInOnePlaneWithTheCamera) {
  test::RandomLines random(23);
  std::vector<Segment3> segments = test::randomSegments(20, &random);
  for (Segment3& segment : segments) {
    segment.a.y() = 0.1 * segment.a.x() + 0.05 * segment.a.z();
    segment.b.y() = 0.1 * segment.b.x() + 0.05 * segment.b.z();
  }
  // The second camera stands in the plane too.
  const Eigen::Vector3d inside(0.4, 0.1 * 0.4 + 0.05 * 0.1, 0.1);
  Pose motion = someMotion();
  motion.translation = -(motion.rotation * inside);
  expectRefused(segments, PoseFailure::kDegenerate, motion);
}

TEST(RobustPose, AcceptsLinesOfAnotherPlane) {
  test::RandomLines random(24);
  std::vector<Segment3> segments = test::randomSegments(20, &random);
  for (Segment3& segment : segments) {
    for (Eigen::Vector3d* end : {&segment.a, &segment.b}) {
      *end *= 3 / end->z();
    }
  }
  SpatialMatches matches = test::observe(segments, someMotion(), camera());
  test::addNoise(0.5, camera(), &random, &matches);
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_LT(errorsOf(result, someMotion()).rotation, 0.5);
  EXPECT_LT(errorsOf(result, someMotion()).translation, 0.03);
}

TEST(RobustPose, RefusesMatchesThatAreAllWrong) {
  for (std::uint64_t seed = 30; seed < 50; ++seed) {
    test::RandomLines random(seed);
    SpatialMatches matches =
        test::observe(test::randomSegments(50, &random), someMotion(), camera());
    test::makeWrong(1, &random, &matches);
    const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
    EXPECT_EQ(result.failure, PoseFailure::kNoConsensus) << seed << ": " << result.reason;
  }
}

TEST(RobustPose, LeavesOutWhatHasNoLength) {
  test::RandomLines random(9);
  SpatialMatches matches = test::observe(test::randomSegments(20, &random), someMotion(), camera());
  matches[3].first.pixel2 = matches[3].first.pixel1;
  matches[3].first.point2 = matches[3].first.point1;
  matches[7].second.point1.x() = std::numeric_limits<double>::quiet_NaN();
  const RelativePose result = RobustPoseEstimator().estimate(matches, camera());
  ASSERT_TRUE(result.found()) << result.reason;
  EXPECT_EQ(result.inliers.size(), 18U);
  EXPECT_LT(errorsOf(result, someMotion()).rotation, 1e-6);
}

TEST(RobustPose, RefusesOptionsOutOfRange) {
  const auto refuses = [](void (*change)(RobustPoseOptions*), const std::string& key) {
    RobustPoseOptions options;
    change(&options);
    test::expectError<ConfigError>([&] { RobustPoseEstimator estimator(options); }, {key});
  };
  refuses([](RobustPoseOptions* o) { o->threshold = 0; }, "threshold");
  refuses([](RobustPoseOptions* o) { o->loss_scale = -1; }, "loss_scale");
  refuses([](RobustPoseOptions* o) { o->confidence = 1; }, "confidence");
  refuses([](RobustPoseOptions* o) { o->min_samples = 0; }, "min_samples");
  refuses([](RobustPoseOptions* o) { o->max_samples = 5; }, "max_samples");
  refuses([](RobustPoseOptions* o) { o->min_inlier_ratio = 1.5; }, "min_inlier_ratio");
  refuses([](RobustPoseOptions* o) { o->min_angle = 90; }, "min_angle");
  refuses([](RobustPoseOptions* o) { o->refinement_steps = 0; }, "refinement_steps");
}

}  // namespace
}  // namespace evolin
