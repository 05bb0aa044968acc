// Interpolation and inverse of poses: hand-computed cases and properties.
#include "evolin_ros/geometry/pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace evolin {
namespace {

constexpr double kPi = 3.14159265358979323846;

Pose aboutZ(double angle, const Eigen::Vector3d& translation) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
  pose.translation = translation;
  return pose;
}

TEST(InterpolatePose, GivesTheEndsAtZeroAndOne) {
  const Pose a = aboutZ(0.3, {1, 2, 3});
  const Pose b = aboutZ(1.1, {-1, 0, 5});
  EXPECT_LT(interpolate(a, b, 0).rotation.angularDistance(a.rotation), 1e-12);
  EXPECT_LT((interpolate(a, b, 0).translation - a.translation).norm(), 1e-12);
  EXPECT_LT(interpolate(a, b, 1).rotation.angularDistance(b.rotation), 1e-12);
  EXPECT_LT((interpolate(a, b, 1).translation - b.translation).norm(), 1e-12);
}

TEST(InterpolatePose, MovesInProportionToTheFraction) {
  const Pose quarter = interpolate(aboutZ(0, {0, 0, 0}), aboutZ(kPi / 2, {4, 8, 0}), 0.25);
  EXPECT_NEAR(quarter.rotation.angularDistance(Eigen::Quaterniond::Identity()), kPi / 8, 1e-12);
  EXPECT_LT((quarter.translation - Eigen::Vector3d(1, 2, 0)).norm(), 1e-12);
}

TEST(InterpolatePose, TakesTheShorterArcWhateverTheQuaternionsSign) {
  const Pose a = aboutZ(0, {0, 0, 0});
  Pose b = aboutZ(1.0, {0, 0, 0});
  b.rotation.coeffs() *= -1;
  EXPECT_NEAR(interpolate(a, b, 0.5).rotation.angularDistance(a.rotation), 0.5, 1e-12);
}

TEST(InterpolatePose, KeepsTheQuaternionAUnitOne) {
  const Pose a = aboutZ(-2, {0, 0, 0});
  const Pose b = aboutZ(1, {0, 0, 0});
  for (double fraction = 0; fraction <= 1; fraction += 0.1) {
    EXPECT_NEAR(interpolate(a, b, fraction).rotation.norm(), 1, 1e-12);
  }
}

TEST(InversePose, UndoesTheMotion) {
  const Pose pose = aboutZ(kPi / 2, {1, 2, 3});
  const Pose back = inverse(pose);
  // (1, 0, 0) turns to (0, 1, 0) and moves to (1, 3, 3).
  const Eigen::Vector3d moved(1, 3, 3);
  EXPECT_LT((back.rotation * moved + back.translation - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((inverse(back).translation - pose.translation).norm(), 1e-12);
  EXPECT_LT(inverse(back).rotation.angularDistance(pose.rotation), 1e-12);
}

}  // namespace
}  // namespace evolin
