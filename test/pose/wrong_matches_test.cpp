// Both strategies on the published solver's inputs with pixel noise and wrong matches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "evolin_ros/metrics/pose_error.h"
#include "evolin_ros/pose/evolin_pose.h"
#include "evolin_ros/pose/robust_pose.h"
#include "test/pose/golden_pairs.h"
#include "test/pose/line_scene.h"

namespace evolin {
namespace {

constexpr int kRepeats = 10;
constexpr double kNoise = 1;  // pixels

struct Case {
  SpatialMatches matches;
  Pose truth;
};

/// Every golden pair with its true motion.
std::vector<Case> casesOf(const test::GoldenPairs& golden, bool poses_lag) {
  std::vector<Case> cases;
  for (std::size_t pair = poses_lag ? 1 : 0; pair < golden.pairs.size(); ++pair) {
    // The living room's published poses lag one frame: the pair before has this pair's motion.
    cases.push_back({golden.pairs[pair].matches, golden.pairs[poses_lag ? pair - 1 : pair].truth});
  }
  return cases;
}

struct Summary {
  double rotation_median = 0;
  double rotation_90 = 0;
  double translation_median = 0;
  double translation_90 = 0;
  double success_rate = 0;  ///< within 1 degree and 0.1 m
};

class Collected {
 public:
  void add(const RelativePose& result, const Pose& truth) {
    PoseErrors errors;
    errors.rotation = std::numeric_limits<double>::infinity();
    errors.translation = errors.rotation;
    if (result.found()) {
      errors = poseErrors(truth, result.first_to_second, Protocol::kPaper).value();
    }
    rotations_.push_back(errors.rotation);
    translations_.push_back(errors.translation);
    successes_ += errors.rotation <= 1 && errors.translation <= 0.1 ? 1 : 0;
  }

  Summary summary() {
    return {at(&rotations_, 0.5), at(&rotations_, 0.9), at(&translations_, 0.5),
            at(&translations_, 0.9), successes_ / static_cast<double>(rotations_.size())};
  }

 private:
  static double at(std::vector<double>* values, double fraction) {
    std::sort(values->begin(), values->end());
    return (*values)[static_cast<std::size_t>(fraction * static_cast<double>(values->size() - 1))];
  }

  std::vector<double> rotations_;
  std::vector<double> translations_;
  double successes_ = 0;
};

void print(const char* data, double share, const char* strategy, const Summary& s) {
  std::printf(
      "%-12s %3.0f %% wrong  %-6s  rotation %9.4f %9.4f deg  translation %8.4f %8.4f m  "
      "success %5.1f %%\n",
      data, 100 * share, strategy, s.rotation_median, s.rotation_90, s.translation_median,
      s.translation_90, 100 * s.success_rate);
}

/// Summaries of `evolin` and `robust` with a share of wrong matches.
std::pair<Summary, Summary> compare(const char* data, const test::GoldenPairs& golden,
                                    bool poses_lag, double share) {
  const EvolinPoseEstimator evolin;
  const RobustPoseEstimator robust;
  Collected evolin_errors;
  Collected robust_errors;
  std::uint64_t seed = 0;
  for (const Case& each : casesOf(golden, poses_lag)) {
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      test::RandomLines random(++seed);
      SpatialMatches matches = each.matches;
      test::addNoise(kNoise, golden.camera, &random, &matches);
      test::makeWrong(share, &random, &matches);
      evolin_errors.add(evolin.estimate(matches, golden.camera), each.truth);
      robust_errors.add(robust.estimate(matches, golden.camera), each.truth);
    }
  }
  const std::pair<Summary, Summary> result{evolin_errors.summary(), robust_errors.summary()};
  print(data, share, "evolin", result.first);
  print(data, share, "robust", result.second);
  return result;
}

void expectRobustAhead(const char* data, const test::GoldenPairs& golden, bool poses_lag) {
  for (const double share : {0.0, 0.2, 0.4, 0.6}) {
    const auto [evolin, robust] = compare(data, golden, poses_lag, share);
    // Without wrong matches it is the spread that shrinks; with them the other's figures run away.
    const double margin = share == 0 ? 0.75 : share < 0.3 ? 0.6 : 0.45;
    EXPECT_LT(robust.rotation_median, margin * evolin.rotation_median) << data << ", " << share;
    EXPECT_LT(robust.rotation_90, margin * evolin.rotation_90) << data << ", " << share;
    EXPECT_LT(robust.translation_median, margin * evolin.translation_median)
        << data << ", " << share;
    EXPECT_LT(robust.translation_90, margin * evolin.translation_90) << data << ", " << share;
    EXPECT_GE(robust.success_rate, evolin.success_rate) << data << ", " << share;
    if (share > 0.3) {
      EXPECT_GT(robust.success_rate, evolin.success_rate + 0.2) << data << ", " << share;
    }
  }
}

TEST(WrongMatches, RobustIsAheadOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  expectRobustAhead("living room", test::goldenLivingRoom(), true);
}

TEST(WrongMatches, RobustIsAheadOnTheDrawnScene) {
  EVOLIN_REQUIRE_SHARED_DATA();
  expectRobustAhead("drawn scene", test::goldenDrawnScene(), false);
}

TEST(WrongMatches, RobustNeverTrustsMatchesThatAreAllWrong) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const RobustPoseEstimator robust;
  for (const test::GoldenPairs& golden : {test::goldenLivingRoom(), test::goldenDrawnScene()}) {
    for (std::size_t pair = 0; pair < golden.pairs.size(); ++pair) {
      test::RandomLines random(pair);
      SpatialMatches matches = golden.pairs[pair].matches;
      test::makeWrong(1, &random, &matches);
      EXPECT_FALSE(robust.estimate(matches, golden.camera).found()) << pair;
    }
  }
}

}  // namespace
}  // namespace evolin
