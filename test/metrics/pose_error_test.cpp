// Errors of relative poses: small cases by hand, properties, and the published figures.
#include "evolin_ros/metrics/pose_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evolin_ros/base/error.h"
#include "test/pose/golden_pairs.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pose pose(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  Pose result;
  result.rotation = Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized());
  result.translation = translation;
  return result;
}

PosePair pair(double rotation, double angle, double translation) {
  PosePair result;
  result.errors = PoseErrors{rotation, angle, translation};
  result.moved = 1;
  return result;
}

PoseErrorMetrics metricsOf(const std::vector<PosePair>& pairs) {
  PoseErrorMetrics metrics;
  for (const PosePair& each : pairs) {
    metrics.addPair(each);
  }
  return metrics;
}

TEST(RelativeMotion, MapsTheFirstCamerasPointsToTheSecond) {
  const Pose first = pose(30, {1, 2, 3}, {1, -2, 0.5});
  const Pose second = pose(-50, {0, 1, 1}, {0.3, 0.1, 2});
  const Eigen::Vector3d point(0.7, -0.4, 3);  // in the first camera
  const Eigen::Vector3d world = first.rotation * point + first.translation;
  const Eigen::Vector3d expected = second.rotation.conjugate() * (world - second.translation);
  const Pose motion = relativeMotion(first, second);
  EXPECT_LT((motion.rotation * point + motion.translation - expected).norm(), 1e-12);
}

TEST(PoseErrors, AreZeroForTheTruthItself) {
  const Pose truth = pose(40, {1, 1, 0}, {0.3, 0.2, -1});
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const PoseErrors errors = poseErrors(truth, truth, protocol).value();
    EXPECT_LT(errors.rotation, 1e-12);
    EXPECT_LT(errors.translation_angle, 1e-12);
    EXPECT_LT(errors.translation, 1e-12);
  }
}

TEST(PoseErrors, AreTheAnglesAndTheLength) {
  const Pose truth = pose(90, {0, 0, 1}, {2, 0, 0});
  const Pose estimate = pose(70, {0, 0, 1}, {0, 1, 0});
  const PoseErrors paper = poseErrors(truth, estimate, Protocol::kPaper).value();
  EXPECT_NEAR(paper.rotation, 20, 1e-10);
  EXPECT_NEAR(paper.translation_angle, 90, 1e-10);
  EXPECT_NEAR(paper.translation, std::sqrt(5), 1e-12);
  // T_truth inv(T_estimate): (2, 0, 0) less (0, 1, 0) turned by 20 degrees about z.
  const double c = std::cos(20 * M_PI / 180);
  const double s = std::sin(20 * M_PI / 180);
  const PoseErrors evolin = poseErrors(truth, estimate, Protocol::kEvolin).value();
  EXPECT_NEAR(evolin.translation, std::hypot(2 + s, c), 1e-12);
  EXPECT_NEAR(evolin.rotation, 20, 1e-10);
}

TEST(PoseErrors, ResolveRotationsFarBelowTheArcCosine) {
  const PoseErrors errors =
      poseErrors(pose(1e-9, {1, 0, 0}, {1, 0, 0}), pose(0, {1, 0, 0}, {1, 0, 0}), Protocol::kPaper)
          .value();
  EXPECT_NEAR(errors.rotation, 1e-9, 1e-15);
}

TEST(PoseErrors, AreNumbersWithoutAnyTranslation) {
  const Pose still;
  const Pose moved = pose(0, {1, 0, 0}, {0.1, 0, 0});
  EXPECT_EQ(poseErrors(still, still, Protocol::kEvolin)->translation_angle, 0);
  EXPECT_EQ(poseErrors(still, moved, Protocol::kEvolin)->translation_angle, 90);
  EXPECT_EQ(poseErrors(moved, still, Protocol::kEvolin)->translation_angle, 90);
}

TEST(PoseErrors, AreNoneOfAnEstimateThatIsNotFinite) {
  Pose estimate;
  estimate.translation.y() = std::nan("");
  EXPECT_FALSE(poseErrors({}, estimate, Protocol::kEvolin));
  EXPECT_FALSE(meanErrors(PoseErrors{}, std::nullopt));
  EXPECT_EQ(meanErrors(PoseErrors{1, 2, 3}, PoseErrors{3, 5, 7})->translation_angle, 3.5);
}

TEST(PoseErrorMetrics, CountsAFailureAsInfinite) {
  PoseErrorMetrics metrics = metricsOf({pair(1, 10, 0.1), PosePair{}, pair(3, 30, 0.3)});
  EXPECT_EQ(metrics.pairs(), 3U);
  EXPECT_EQ(metrics.failed(), 1U);
  EXPECT_EQ(metrics.medians().rotation, 3);
  EXPECT_EQ(metrics.medians().translation_angle, 30);
  EXPECT_EQ(metrics.medians().translation, 0.3);
  metrics.addPair({});
  EXPECT_EQ(metrics.medians().rotation, kInfinity);
  EXPECT_NEAR(metrics.rotationStatistics().mean, 2, 1e-15);
}

TEST(PoseErrorMetrics, MedianOfAnEvenNumberIsTheMiddle) {
  EXPECT_EQ(
      metricsOf({pair(1, 0, 0), pair(4, 0, 0), pair(2, 0, 0), pair(9, 0, 0)}).medians().rotation,
      3);
}

TEST(PoseErrorMetrics, WeightsCountPairsAsOftenAsTheySay) {
  const PoseErrorMetrics metrics = metricsOf({pair(5, 0, 0), pair(1, 0, 0), pair(3, 0, 0)});
  EXPECT_EQ(metrics.medians({0, 3, 1}).rotation, 1);
  EXPECT_EQ(metrics.medians({1, 0, 1}).rotation, 4);
  EXPECT_TRUE(std::isnan(metrics.medians({0, 0, 0}).rotation));
  test::expectError([&] { metrics.medians({1}); }, {"1 weights", "3"});
}

TEST(PoseErrorMetrics, GivesTheSevenStatistics) {
  const ErrorStatistics s =
      metricsOf({pair(1, 0, 0), pair(2, 0, 0), pair(6, 0, 0), PosePair{}}).rotationStatistics();
  EXPECT_NEAR(s.rmse, std::sqrt(41.0 / 3), 1e-14);
  EXPECT_NEAR(s.mean, 3, 1e-14);
  EXPECT_EQ(s.median, 2);
  EXPECT_NEAR(s.std, std::sqrt(14.0 / 3), 1e-14);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 6);
  EXPECT_EQ(s.sse, 41);
}

TEST(PoseErrorMetrics, HasNoFiguresOfNothing) {
  const PoseErrorMetrics none;
  EXPECT_TRUE(std::isnan(none.medians().rotation));
  EXPECT_TRUE(std::isnan(none.rotationStatistics().rmse));
  EXPECT_TRUE(std::isnan(none.successRate()));
  EXPECT_TRUE(std::isnan(none.areaUnderCurve(5, AngleRule::kSmaller)));
  EXPECT_TRUE(std::isnan(metricsOf({PosePair{}}).translationStatistics().max));
}

TEST(PoseErrorMetrics, AreaUnderTheCurveByHand) {
  // Errors 1 and 3 of four pairs: the share rises to 1/4 at 1, to 1/2 at 3, and stays.
  const PoseErrorMetrics metrics =
      metricsOf({pair(1, 50, 0), pair(40, 3, 0), PosePair{}, pair(20, 30, 0)});
  const double area = 0.5 * 1 * 0.25 + 2 * (0.25 + 0.5) / 2 + 2 * 0.5;
  EXPECT_NEAR(metrics.areaUnderCurve(5, AngleRule::kSmaller), area / 5, 1e-15);
  EXPECT_EQ(metrics.areaUnderCurve(5, AngleRule::kLarger), 0);
  test::expectError([&] { metrics.areaUnderCurve(0, AngleRule::kSmaller); }, {"threshold 0"});
  test::expectError([&] { metrics.areaUnderCurve(std::nan(""), AngleRule::kSmaller); }, {"nan"});
}

TEST(PoseErrorMetrics, AreaGrowsWithTheThresholdAndStaysBelowOne) {
  test::RandomLines random(1);
  PoseErrorMetrics metrics;
  for (int i = 0; i < 100; ++i) {
    metrics.addPair(pair(random.uniform(0, 20), random.uniform(0, 20), 0));
  }
  double before = 0;
  for (double threshold = 0.5; threshold < 40; threshold += 0.5) {
    const double area = metrics.areaUnderCurve(threshold, AngleRule::kSmaller);
    EXPECT_GE(area, before);
    EXPECT_LE(area, 1);
    EXPECT_LE(metrics.areaUnderCurve(threshold, AngleRule::kLarger), area);
    before = area;
  }
  EXPECT_GT(before, 0.8);
}

TEST(PoseErrorMetrics, CountsNearlyStaticIllConditionedAndSuccessfulPairs) {
  PosePair still = pair(0.5, 170, 0.004);
  still.moved = 0.009;
  PosePair shaky = pair(0.2, 5, 0.2);
  shaky.ill_conditioned = true;
  const PoseErrorMetrics metrics = metricsOf({still, shaky, pair(2, 1, 0.01), PosePair{}});
  EXPECT_EQ(metrics.nearStatic(), 2U);  // the failed one has moved by 0
  EXPECT_EQ(metrics.illConditioned(), 1U);
  EXPECT_EQ(metrics.successRate(), 0.25);
}

TEST(PoseErrorMetrics, DoesNotDependOnOrderOrMerging) {
  test::RandomLines random(2);
  std::vector<PosePair> pairs;
  pairs.reserve(101);
  for (int i = 0; i < 101; ++i) {
    pairs.push_back(
        i % 10 == 0 ? PosePair{}
                    : pair(random.uniform(0, 3), random.uniform(0, 90), random.uniform(0, 0.1)));
  }
  const PoseErrorMetrics all = metricsOf(pairs);
  random.shuffle(&pairs);
  PoseErrorMetrics left = metricsOf({pairs.begin(), pairs.begin() + 40});
  const PoseErrorMetrics right = metricsOf({pairs.begin() + 40, pairs.end()});
  left.merge(right);
  EXPECT_EQ(left.pairs(), all.pairs());
  EXPECT_EQ(left.failed(), all.failed());
  EXPECT_EQ(left.medians().translation, all.medians().translation);
  EXPECT_EQ(left.rotationStatistics().sse, all.rotationStatistics().sse);
  EXPECT_EQ(left.translationStatistics().std, all.translationStatistics().std);
  EXPECT_EQ(left.areaUnderCurve(3, AngleRule::kSmaller),
            all.areaUnderCurve(3, AngleRule::kSmaller));
  EXPECT_EQ(left.successRate(), all.successRate());
  left.merge(left);
  EXPECT_EQ(left.pairs(), 2 * all.pairs());
  EXPECT_EQ(left.medians().rotation, all.medians().rotation);
  left.reset();
  EXPECT_EQ(left.pairs(), 0U);
}

TEST(PoseErrorMetrics, RefusesOptionsOutOfRangeAndUnequalMerges) {
  PoseErrorOptions options;
  options.near_static = -1;
  test::expectError<ConfigError>([&] { PoseErrorMetrics metrics(options); }, {"near_static", "-1"});
  options = {};
  options.success_rotation = kInfinity;
  test::expectError<ConfigError>([&] { PoseErrorMetrics metrics(options); }, {"success_rotation"});
  options = {};
  options.success_translation = 1;
  PoseErrorMetrics other(options);
  test::expectError([&] { other.merge(PoseErrorMetrics()); }, {"options"});
}

/// Errors of the published poses, and everything that the published script makes of them.
void expectGolden(const test::GoldenPairs& golden) {
  PoseErrorMetrics metrics;
  for (const test::GoldenPair& each : golden.pairs) {
    Pose back;
    back.rotation = each.truth.rotation.conjugate();
    back.translation = -(back.rotation * each.truth.translation);
    const PoseErrors forward =
        poseErrors(each.truth, each.first_to_second, Protocol::kEvolin).value();
    const PoseErrors backward = poseErrors(back, each.second_to_first, Protocol::kEvolin).value();
    EXPECT_NEAR(forward.translation_angle, each.forward_errors[0], 1e-6);
    EXPECT_NEAR(forward.rotation, each.forward_errors[1], 1e-6);
    EXPECT_NEAR(forward.translation, each.forward_errors[2], 1e-9);
    EXPECT_NEAR(backward.translation_angle, each.backward_errors[0], 1e-6);
    EXPECT_NEAR(backward.rotation, each.backward_errors[1], 1e-6);
    EXPECT_NEAR(backward.translation, each.backward_errors[2], 1e-9);
    PosePair result;
    result.errors = meanErrors(forward, backward);
    metrics.addPair(result);
  }
  const PoseErrors medians = metrics.medians();
  for (const nlohmann::json& entry : golden.results) {
    const std::string name = entry["name"];
    const double value = entry["value"];
    if (name == "median_angular_rotation_error") {
      EXPECT_NEAR(medians.rotation, value, 1e-6);
    } else if (name == "median_angular_translation_error") {
      EXPECT_NEAR(medians.translation_angle, value, 1e-6);
    } else if (name == "median_absolute_translation_error") {
      EXPECT_NEAR(medians.translation, value, 1e-9);
    } else {
      ASSERT_EQ(name, "pose_error_auc");
      const double threshold =
          entry["additional_information"]["threshold_information"]["threshold"];
      EXPECT_NEAR(metrics.areaUnderCurve(threshold, AngleRule::kSmaller), value, 1e-7);
    }
  }
}

TEST(PoseErrorMetrics, EqualsThePublishedFigures) {
  EVOLIN_REQUIRE_SHARED_DATA();
  expectGolden(test::goldenLivingRoom());
  expectGolden(test::goldenDrawnScene());
}

}  // namespace
}  // namespace evolin
