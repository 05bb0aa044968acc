// What the metrics of a pair share against what each of them works out for itself.
#include "evolin_ros/metrics/projected_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "evolin_ros/metrics/best_localization.h"
#include "evolin_ros/metrics/one_to_one_repeatability.h"
#include "evolin_ros/metrics/repeatability.h"
#include "test/metrics/spatial_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr Protocol kProtocols[] = {Protocol::kEvolin, Protocol::kPaper};
constexpr LineDistance kDistances[] = {LineDistance::kOrthogonal, LineDistance::kStructural};

/// Two views of a wall, some of whose lines have no depth or leave the image.
struct Views {
  SpatialFrame first;
  SpatialFrame second;

  explicit Views(Protocol protocol) {
    test::RandomLines random(17);
    const LineSegments world = random.anywhere(60, 150, 128);
    first = test::halfWallFrame(protocol, random.detectionsOf(world, 200, 3), 115);
    second = test::halfWallFrame(protocol, random.detectionsOf(world, 180, 3), 120, 6);
  }
};

double nearestDistance(const LineSegment& query, const SpatialFrame& frame, LineDistance distance) {
  double nearest = INFINITY;
  for (const SpatialLine& line : frame.lines) {
    if (line.in_image) {
      nearest = std::min(nearest, distance == LineDistance::kStructural
                                      ? structuralDistance(query, line.segment)
                                      : orthogonalDistance(query, line.segment,
                                                           frame.protocol == Protocol::kEvolin));
    }
  }
  return nearest;
}

TEST(ProjectedLines, DistancesAreThoseOfAnExhaustiveSearchWhateverWasAskedBefore) {
  for (const Protocol protocol : kProtocols) {
    const Views views(protocol);
    for (const LineDistance distance : kDistances) {
      ProjectedLines projected(views.first, views.second, kNoScore);
      double longest = 0;
      for (const double reach : {2.0, 0.5, 15.0, 8.0, 500.0}) {
        longest = std::max(longest, reach);
        const std::vector<double>& distances = projected.nearestDistances(distance, reach);
        ASSERT_EQ(distances.size(), projected.projections().size());
        ASSERT_GT(distances.size(), 40U);
        for (std::size_t index = 0; index < distances.size(); ++index) {
          // One pixel of these images is one of the scaled frame.
          const double expected =
              nearestDistance(projected.projections()[index].segment, views.second, distance);
          EXPECT_EQ(distances[index], expected <= longest ? expected : INFINITY);
        }
      }
    }
  }
}

TEST(ProjectedLines, ScaledProjectionsCarryTheScoresOfTheirLines) {
  const Views views(Protocol::kPaper);
  ProjectedLines projected(views.first, views.second, 0.4);
  ASSERT_FALSE(projected.projections().empty());
  const LineSegments& scaled = projected.scaledProjections();
  ASSERT_EQ(scaled.size(), projected.projections().size());
  for (std::size_t index = 0; index < scaled.size(); ++index) {
    const LineProjection& projection = projected.projections()[index];
    EXPECT_EQ(scaled[index].score, views.first.lines[projection.row].segment.score);
    EXPECT_GT(scaled[index].score, 0.4);
    EXPECT_EQ(scaled[index].x1, projection.segment.x1);
  }
}

TEST(ProjectedPair, MetricsSayTheSameOfAPairThatTheyShare) {
  for (const Protocol protocol : kProtocols) {
    const Views views(protocol);
    RepeatabilityOptions options;
    options.protocol = protocol;
    RepeatabilityOptions by_score = options;
    by_score.score_thresholds = {0.25, 0.5};
    for (const bool best_first : {false, true}) {
      ProjectedPair pair(views.first, views.second);
      for (const LineDistance distance : kDistances) {
        BestLocalizationOptions best;
        best.distance = distance;
        best.count = 60;
        const auto expect_best = [&] {
          const PairBestLocalization expected =
              measureBestLocalization(views.first, views.second, best);
          const PairBestLocalization actual = measureBestLocalization(best, &pair);
          EXPECT_EQ(actual.used, expected.used);
          EXPECT_EQ(actual.mean_distance, expected.mean_distance);
          EXPECT_GT(actual.mean_distance, 0);
        };
        if (best_first) {
          expect_best();
        }
        for (const RepeatabilityOptions& each : {options, by_score}) {
          const RepeatabilityMetrics metrics(each);
          const auto expected = metrics.measure(views.first, views.second);
          const auto actual = metrics.measure(&pair);
          ASSERT_EQ(actual.size(), expected.size());
          for (std::size_t index = 0; index < expected.size(); ++index) {
            EXPECT_EQ(actual[index].lines, expected[index].lines);
            EXPECT_EQ(actual[index].forward.count, expected[index].forward.count);
            EXPECT_EQ(actual[index].forward.distance_sum, expected[index].forward.distance_sum);
            EXPECT_EQ(actual[index].backward.count, expected[index].backward.count);
            EXPECT_EQ(actual[index].backward.distance_sum, expected[index].backward.distance_sum);
          }
        }
        expect_best();
      }
      OneToOneRepeatability alone;
      OneToOneRepeatability shared;
      alone.addPair(views.first, views.second);
      shared.addPair(pair);
      EXPECT_EQ(shared.matched(), alone.matched());
      EXPECT_EQ(shared.byLength(), alone.byLength());
      EXPECT_GT(shared.matched(), 20U);
    }
  }
}

TEST(ProjectedPair, RefusesFramesOfDifferentProtocols) {
  const Views evolin(Protocol::kEvolin);
  const Views paper(Protocol::kPaper);
  test::expectError([&] { ProjectedPair pair(evolin.first, paper.second); }, {"protocols"});
}

}  // namespace
}  // namespace evolin
