// Analytic derivatives of the observations against numeric ones, and the motions that they are
// taken along.
#include "src/pose/line_residual.h"

#include <gtest/gtest.h>

#include <limits>

#include "src/pose/line_alignment.h"
#include "src/pose/two_view_line.h"
#include "test/pose/line_scene.h"

namespace evolin {
namespace {

Camera camera(double fy) {
  Camera camera;
  camera.fx = 481.2;
  camera.fy = fy;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

Vector6d randomTwist(test::RandomLines* random, double rotation, double translation) {
  Vector6d twist;
  for (int i = 0; i < 6; ++i) {
    twist[i] = (i < 3 ? rotation : translation) * random->uniform(-1, 1);
  }
  return twist;
}

/// Central differences of `value` (a function of a motion) along exp(d) * motion.
template <int Rows, typename Value>
Eigen::Matrix<double, Rows, 6> numericJacobian(const Pose& motion, const Value& value) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, Rows, 6> jacobian;
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6d step = kStep * Vector6d::Unit(axis);
    jacobian.col(axis) =
        (value(compose(expMotion(step), motion)) - value(compose(expMotion(-step), motion))) /
        (2 * kStep);
  }
  return jacobian;
}

class Jacobians : public ::testing::TestWithParam<double> {};

TEST_P(Jacobians, OfTheResidualEqualNumericOnes) {
  const Camera pinhole = camera(GetParam());
  test::RandomLines random(1);
  for (const bool normalised : {false, true}) {
    for (const SpatialMatch& match :
         test::observe(test::randomSegments(50, &random), Pose(), pinhole)) {
      const Eigen::Vector3d line = imageLine(match.first, normalised);
      const Pose motion = expMotion(randomTwist(&random, 0.3, 0.3));
      const auto moved = [&](const Pose& pose) -> Eigen::Vector3d {
        return pose.rotation * match.second.point1 + pose.translation;
      };
      const auto value = [&](const Pose& pose) {
        return Eigen::Matrix<double, 1, 1>(lineResidual(line, pinhole, moved(pose)));
      };
      const Eigen::Vector3d point = moved(motion);
      const Eigen::Matrix<double, 1, 6> analytic =
          lineResidualJacobian(point, lineResidualGradient(line, pinhole, point));
      const Eigen::Matrix<double, 1, 6> numeric = numericJacobian<1>(motion, value);
      ASSERT_LT((analytic - numeric).norm(), 1e-6 * (1 + analytic.norm()));
    }
  }
}

TEST_P(Jacobians, OfBothViewsEqualNumericOnes) {
  const Camera pinhole = camera(GetParam());
  test::RandomLines random(2);
  const Pose truth = expMotion(randomTwist(&random, 0.2, 0.2));
  const std::vector<TwoViewLine> lines =
      makeTwoViewLines(test::observe(test::randomSegments(50, &random), truth, pinhole));
  ASSERT_EQ(lines.size(), 50U);
  for (const TwoViewLine& line : lines) {
    const Pose motion = compose(expMotion(randomTwist(&random, 0.1, 0.1)), truth);
    for (const auto linearise : {lineariseForward, lineariseBackward}) {
      const auto value = [&](const Pose& pose) {
        LinearisedDistances distances;
        EXPECT_TRUE(linearise(line, pose, pinhole, &distances));
        return distances.values;
      };
      LinearisedDistances analytic;
      ASSERT_TRUE(linearise(line, motion, pinhole, &analytic));
      const Eigen::Matrix<double, 2, 6> numeric = numericJacobian<2>(motion, value);
      ASSERT_LT((analytic.jacobian - numeric).norm(), 1e-6 * (1 + numeric.norm()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EitherImageAxis, Jacobians, ::testing::Values(480.0, -480.0));

TEST(LineResidual, IsThePixelDistanceTimesTheLength) {
  LiftedLine line;
  line.pixel1 = {100, 50};
  line.pixel2 = {300, 50};
  const Camera pinhole = camera(480);
  const Eigen::Vector3d point = test::backProjectPoint(pinhole, {200, 57}, 2);
  EXPECT_NEAR(lineResidual(imageLine(line, false), pinhole, point), 7 * 200, 1e-9);
  EXPECT_NEAR(lineResidual(imageLine(line, true), pinhole, point), 7, 1e-12);
}

TEST(TwoViewLine, IsInfinitelyFarBehindTheCamera) {
  const PointsOnLine seen = {{Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)},
                             Eigen::Vector3d(1, 0, -319.5)};
  EXPECT_EQ(
      squaredDistance(seen, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), camera(480)),
      std::numeric_limits<double>::infinity());
  EXPECT_EQ(
      squaredDistance(seen, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 2), camera(480)), 0);
}

TEST(RigidMotion, LogarithmInvertsTheExponential) {
  test::RandomLines random(3);
  for (const double size : {1e-12, 1e-6, 0.0099, 0.0101, 0.5, 1.7}) {
    for (int i = 0; i < 20; ++i) {
      const Vector6d twist = randomTwist(&random, size, size);
      EXPECT_LT((logMotion(expMotion(twist)) - twist).norm(), 1e-12 * (1 + twist.norm()) * 10);
    }
  }
  EXPECT_EQ(logMotion(Pose()).norm(), 0);
}

TEST(RigidMotion, ExponentialOfASumAlongOneTwistIsTheProduct) {
  test::RandomLines random(4);
  for (const double size : {1e-3, 0.1, 1.0}) {
    const Vector6d twist = randomTwist(&random, size, size);
    const Pose twice = compose(expMotion(twist), expMotion(twist));
    EXPECT_LT((logMotion(twice) - 2 * twist).norm(), 1e-12);
  }
}

TEST(RigidMotion, AdjointMovesAStepAcross) {
  test::RandomLines random(5);
  const Pose motion = expMotion(randomTwist(&random, 1, 2));
  const Vector6d step = randomTwist(&random, 0.1, 0.1);
  const Pose after = compose(motion, expMotion(step));
  const Pose before = compose(expMotion(adjoint(motion) * step), motion);
  EXPECT_LT(logMotion(compose(after, inverse(before))).norm(), 1e-12);
}

TEST(AlignLines, FindsTheMotionOfTwoLinesInSpace) {
  test::RandomLines random(6);
  for (int i = 0; i < 50; ++i) {
    const Pose truth = expMotion(randomTwist(&random, 1.5, 2));
    std::vector<DirectedLine> first;
    std::vector<DirectedLine> second;
    for (const test::Segment3& segment : test::randomSegments(2, &random)) {
      const Eigen::Vector3d direction = (segment.b - segment.a).normalized();
      const Eigen::Vector3d other = segment.a + random.uniform(-1, 1) * direction;
      const double sign = random.uniform(-1, 1) < 0 ? -1 : 1;
      first.push_back({segment.a, direction});
      second.push_back(
          {truth.rotation * other + truth.translation, sign * (truth.rotation * direction)});
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (const Pose& motion : alignLines(first[0], first[1], second[0], second[1], 0.01, 0.1)) {
      nearest = std::min(nearest, logMotion(compose(motion, inverse(truth))).norm());
    }
    EXPECT_LT(nearest, 1e-7) << i;
  }
}

TEST(AlignLines, RefusesParallelLinesAndOtherAngles) {
  const DirectedLine x = {{0, 0, 1}, {1, 0, 0}};
  const DirectedLine other_x = {{0, 1, 1}, {-1, 0, 0}};
  const DirectedLine y = {{0, 0, 2}, {0, 1, 0}};
  const DirectedLine slanted = {{0, 0, 2}, Eigen::Vector3d(1, 1, 0).normalized()};
  EXPECT_TRUE(alignLines(x, other_x, x, other_x, 0.01, 0.1).empty());
  EXPECT_TRUE(alignLines(x, y, x, slanted, 0.01, 0.1).empty());
  EXPECT_EQ(alignLines(x, slanted, x, slanted, 0.01, 0.1).size(), 2U);
  EXPECT_EQ(alignLines(x, y, x, y, 0.01, 0.1).size(), 4U);
}

}  // namespace
}  // namespace evolin
