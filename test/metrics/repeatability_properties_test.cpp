// Repeatability against an exhaustive computation, and what holds for any lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evolin_ros/metrics/repeatability.h"
#include "evolin_ros/metrics/resampled_repeatability.h"
#include "test/metrics/spatial_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr Protocol kProtocols[] = {Protocol::kEvolin, Protocol::kPaper};

RepeatabilityOptions optionsOf(Protocol protocol) {
  RepeatabilityOptions options;
  options.protocol = protocol;
  options.frame_steps = {1};
  return options;
}

/// A sequence before a bumpy wall with holes, 200 x 160 pixels, some lines outside the image.
struct Scene {
  cv::Mat depth;
  std::vector<LineSegments> lines;
  std::vector<Pose> poses;

  explicit Scene(int frames, double unit = 1) : depth(160, 200, CV_32FC1) {
    test::RandomLines random(11);
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        depth.at<float>(y, x) = static_cast<float>(
            (random.index(8) == 0 ? 0 : 2 + 0.25 * ((x / 40 + y / 40) % 3)) * unit);
      }
    }
    const LineSegments world = random.anywhere(40, 220, 180);
    for (int frame = 0; frame < frames; ++frame) {
      lines.push_back(random.detectionsOf(world, 50, 6));
      Pose pose;
      pose.translation = Eigen::Vector3d(0.05 * frame, -0.02 * frame, 0.04 * frame) * unit;
      pose.rotation = Eigen::AngleAxisd(0.02 * frame, Eigen::Vector3d(1, 2, 3).normalized());
      poses.push_back(pose);
    }
  }

  SpatialFrame frame(std::size_t index, Protocol protocol) const {
    return liftLines(protocol, "f", lines[index], DepthMap(depth), test::wallCamera(),
                     poses[index]);
  }
};

/// Redetections written down once more, without search structures.
Redetections exhaustive(const SpatialFrame& from, const SpatialFrame& to, LineDistance distance,
                        double threshold) {
  const auto to_scaled = [&to](LineSegment line) {
    line.x1 *= 128.0 / to.size.width;
    line.x2 *= 128.0 / to.size.width;
    line.y1 *= 128.0 / to.size.height;
    line.y2 *= 128.0 / to.size.height;
    return line;
  };
  const bool evolin = to.protocol == Protocol::kEvolin;
  Redetections found;
  for (const LineProjection& projection : projectLines(from, to)) {
    double nearest = INFINITY;
    for (const SpatialLine& line : to.lines) {
      if (line.in_image) {
        const LineSegment a = to_scaled(projection.segment);
        const LineSegment b = to_scaled(line.segment);
        nearest = std::min(nearest, distance == LineDistance::kStructural
                                        ? structuralDistance(a, b)
                                        : orthogonalDistance(a, b, evolin));
      }
    }
    if (evolin ? nearest < threshold : nearest <= threshold) {
      ++found.count;
      found.distance_sum += nearest;
    }
  }
  return found;
}

TEST(RepeatabilityProperties, AgreesWithAnExhaustiveComputation) {
  const Scene scene(4);
  for (const Protocol protocol : kProtocols) {
    const RepeatabilityMetrics metrics(optionsOf(protocol));
    std::uint32_t redetections = 0;
    for (std::size_t second = 1; second < scene.lines.size(); ++second) {
      const SpatialFrame a = scene.frame(second - 1, protocol);
      const SpatialFrame b = scene.frame(second, protocol);
      const auto results = metrics.measure(a, b);
      ASSERT_EQ(results.size(), 6U);
      for (std::size_t index = 0; index < results.size(); ++index) {
        const RepeatabilitySetting& setting = metrics.settings()[index];
        const Redetections there = exhaustive(a, b, setting.distance, setting.distance_threshold);
        const Redetections back = exhaustive(b, a, setting.distance, setting.distance_threshold);
        EXPECT_EQ(results[index].lines, 100U);
        EXPECT_EQ(results[index].forward.count, there.count);
        EXPECT_EQ(results[index].backward.count, back.count);
        EXPECT_NEAR(results[index].forward.distance_sum, there.distance_sum, 1e-9);
        EXPECT_NEAR(results[index].backward.distance_sum, back.distance_sum, 1e-9);
        redetections += there.count;
      }
    }
    EXPECT_GT(redetections, 100U);
  }
}

TEST(RepeatabilityProperties, ASetWithItselfIsPerfect) {
  test::RandomLines random(12);
  for (const Protocol protocol : kProtocols) {
    LineSegments lines = random.anywhere(60, 127, 127);
    for (LineSegment& line : lines) {
      // Whole endpoints, so that kEvolin rounds nothing, and none parallel to an axis.
      line = test::segment(std::floor(line.x1), std::floor(line.y1), std::floor(line.x2),
                           std::floor(line.y2));
      line.x2 += line.x1 == line.x2 ? 1 : 0;
      line.y2 += line.y1 == line.y2 ? 1 : 0;
    }
    const SpatialFrame frame = test::wallFrame(protocol, lines, 5);
    for (const PairRepeatability& pair :
         RepeatabilityMetrics(optionsOf(protocol)).measure(frame, frame)) {
      EXPECT_EQ(pair.repeatability(), 1);
      EXPECT_NEAR(pair.localizationError(protocol), 0, 1e-9);
    }
  }
}

TEST(RepeatabilityProperties, IsBlindToRowsAndEndpointOrder) {
  const Scene scene(2);
  Scene shuffled = scene;
  test::RandomLines random(13);
  for (LineSegments& lines : shuffled.lines) {
    random.shuffle(&lines);
    for (LineSegment& line : lines) {
      if (random.index(2) == 0) {
        std::swap(line.x1, line.x2);
        std::swap(line.y1, line.y2);
      }
    }
  }
  for (const Protocol protocol : kProtocols) {
    const RepeatabilityMetrics metrics(optionsOf(protocol));
    const auto expected = metrics.measure(scene.frame(0, protocol), scene.frame(1, protocol));
    const auto actual = metrics.measure(shuffled.frame(0, protocol), shuffled.frame(1, protocol));
    for (std::size_t index = 0; index < expected.size(); ++index) {
      EXPECT_EQ(actual[index].repeatability(), expected[index].repeatability());
      EXPECT_NEAR(actual[index].localizationError(protocol),
                  expected[index].localizationError(protocol), 1e-9);
    }
  }
}

TEST(RepeatabilityProperties, ExchangedFramesExchangeTheDirections) {
  const Scene scene(2);
  for (const Protocol protocol : kProtocols) {
    const RepeatabilityMetrics metrics(optionsOf(protocol));
    const SpatialFrame a = scene.frame(0, protocol);
    const SpatialFrame b = scene.frame(1, protocol);
    const auto there = metrics.measure(a, b);
    const auto back = metrics.measure(b, a);
    for (std::size_t index = 0; index < there.size(); ++index) {
      EXPECT_EQ(there[index].forward.count, back[index].backward.count);
      EXPECT_EQ(there[index].forward.distance_sum, back[index].backward.distance_sum);
      EXPECT_EQ(there[index].repeatability(), back[index].repeatability());
    }
  }
}

TEST(RepeatabilityProperties, TheUnitOfLengthDoesNotMatter) {
  const Scene metres(2);
  const Scene halves(2, 2);
  for (const Protocol protocol : kProtocols) {
    const RepeatabilityMetrics metrics(optionsOf(protocol));
    const auto expected = metrics.measure(metres.frame(0, protocol), metres.frame(1, protocol));
    const auto actual = metrics.measure(halves.frame(0, protocol), halves.frame(1, protocol));
    for (std::size_t index = 0; index < expected.size(); ++index) {
      EXPECT_EQ(actual[index].repeatability(), expected[index].repeatability());
      EXPECT_EQ(actual[index].forward.distance_sum, expected[index].forward.distance_sum);
    }
  }
}

TEST(RepeatabilityProperties, GrowsWithTheThreshold) {
  const Scene scene(2);
  for (const Protocol protocol : kProtocols) {
    RepeatabilityOptions options = optionsOf(protocol);
    options.distance_thresholds = {1, 2, 4, 8, 16, 32};
    const auto pairs =
        RepeatabilityMetrics(options).measure(scene.frame(0, protocol), scene.frame(1, protocol));
    for (const std::size_t first : {0U, 6U}) {
      for (std::size_t index = first + 1; index < first + 6; ++index) {
        EXPECT_GE(pairs[index].forward.count, pairs[index - 1].forward.count);
        EXPECT_GE(pairs[index].backward.count, pairs[index - 1].backward.count);
      }
      EXPECT_GT(pairs[first + 5].repeatability(), pairs[first].repeatability());
    }
  }
}

TEST(RepeatabilityProperties, ThresholdsAndScoresDoNotInfluenceEachOther) {
  const Scene scene(2);
  RepeatabilityOptions all = optionsOf(Protocol::kEvolin);
  all.score_thresholds = {0.2, 0.6};
  const SpatialFrame a = scene.frame(0, Protocol::kEvolin);
  const SpatialFrame b = scene.frame(1, Protocol::kEvolin);
  const auto together = RepeatabilityMetrics(all).measure(a, b);
  for (std::size_t score = 0; score < 2; ++score) {
    for (std::size_t threshold = 0; threshold < 3; ++threshold) {
      RepeatabilityOptions one = all;
      one.score_thresholds = {all.score_thresholds[score]};
      one.distance_thresholds = {all.distance_thresholds[threshold]};
      const auto alone = RepeatabilityMetrics(one).measure(a, b);
      for (std::size_t distance = 0; distance < 2; ++distance) {
        const PairRepeatability& expected = together[6 * score + 3 * distance + threshold];
        EXPECT_EQ(alone[distance].lines, expected.lines);
        EXPECT_EQ(alone[distance].forward.distance_sum, expected.forward.distance_sum);
        EXPECT_EQ(alone[distance].backward.count, expected.backward.count);
      }
    }
  }
}

void expectSame(const RepeatabilityMetrics& a, const RepeatabilityMetrics& b) {
  EXPECT_EQ(a.pairs(1), b.pairs(1));
  for (std::size_t setting = 0; setting < a.settings().size(); ++setting) {
    ASSERT_EQ(a.figures(setting).has_value(), b.figures(setting).has_value());
    if (a.figures(setting)) {
      EXPECT_EQ(a.figures(setting)->repeatability, b.figures(setting)->repeatability);
      EXPECT_EQ(a.figures(setting)->localization_error, b.figures(setting)->localization_error);
    }
  }
}

RepeatabilityMetrics measurePairs(const Scene& scene, Protocol protocol,
                                  const std::vector<std::size_t>& firsts) {
  RepeatabilityMetrics metrics(optionsOf(protocol));
  for (const std::size_t first : firsts) {
    metrics.addPair(1, scene.frame(first, protocol), scene.frame(first + 1, protocol));
  }
  return metrics;
}

TEST(RepeatabilityProperties, MergeInAnyOrderEqualsAllInOneToTheLastBit) {
  const Scene scene(7);
  for (const Protocol protocol : kProtocols) {
    const RepeatabilityMetrics all = measurePairs(scene, protocol, {0, 1, 2, 3, 4, 5});
    const std::vector<RepeatabilityMetrics> parts = {
        measurePairs(scene, protocol, {4, 1}), measurePairs(scene, protocol, {5}),
        measurePairs(scene, protocol, {}), measurePairs(scene, protocol, {3, 0, 2})};
    std::vector<std::size_t> order = {0, 1, 2, 3};
    do {
      RepeatabilityMetrics merged(optionsOf(protocol));
      for (const std::size_t part : order) {
        merged.merge(parts[part]);
      }
      expectSame(merged, all);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(RepeatabilityProperties, MergeWithItselfDoublesAndResetForgets) {
  const Scene scene(3);
  RepeatabilityMetrics metrics = measurePairs(scene, Protocol::kEvolin, {0, 1});
  const RepeatabilityMetrics once = metrics;
  metrics.merge(metrics);
  EXPECT_EQ(metrics.pairs(1), 4U);
  EXPECT_EQ(metrics.figures(0)->repeatability, once.figures(0)->repeatability);
  metrics.reset();
  expectSame(metrics, measurePairs(scene, Protocol::kEvolin, {}));
}

TEST(RepeatabilityProperties, MergeRefusesOtherOptions) {
  RepeatabilityMetrics metrics(optionsOf(Protocol::kEvolin));
  EXPECT_THROW(metrics.merge(RepeatabilityMetrics(optionsOf(Protocol::kPaper))), Error);
  EXPECT_THROW(metrics.merge(RepeatabilityMetrics()), Error);
}

TEST(RepeatabilityProperties, WeightsCountPairsSeveralTimes) {
  const Scene scene(4);
  for (const Protocol protocol : kProtocols) {
    std::vector<PairRepeatability> pairs;
    RepeatabilitySum sum;
    const std::vector<std::uint32_t> weights = {2, 0, 3};
    for (std::size_t first = 0; first < 3; ++first) {
      pairs.push_back(RepeatabilityMetrics(optionsOf(protocol))
                          .measure(scene.frame(first, protocol), scene.frame(first + 1, protocol))
                          .at(4));
      for (std::uint32_t copy = 0; copy < weights[first]; ++copy) {
        sum.add(pairs.back(), protocol);
      }
    }
    const RepeatabilityFigures weighted = ResampledRepeatability(pairs, protocol).figures(weights);
    EXPECT_NEAR(weighted.repeatability, sum.figures(protocol)->repeatability, 1e-12);
    EXPECT_NEAR(weighted.localization_error, sum.figures(protocol)->localization_error, 1e-12);
    EXPECT_GT(weighted.localization_error, 0);
  }
}

}  // namespace
}  // namespace evolin
