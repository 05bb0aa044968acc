// Association of detected lines through the ground truth near them.
#include "evolin_ros/metrics/detected_association.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evolin_ros/base/error.h"
#include "evolin_ros/metrics/association.h"
#include "test/metrics/vectorized_support.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using Ids = std::vector<std::int64_t>;
using test::expectError;
using test::kUnit;
using test::segment;

LineSegment withId(LineSegment line, std::int64_t id) {
  line.id = id;
  return line;
}

TEST(CarryOverIds, TakesTheNearestLineWithinTheGate) {
  const LineSegments truth = {withId(segment(10, 10, 50, 30), 7),
                              withId(segment(10, 14, 50, 34), 8)};
  const LineSegments detected = {
      segment(10, 11, 50, 31),     // 2 from id 7, 6 from id 8
      segment(50, 33, 10, 13),     // 2 from id 8, the other way round
      segment(10, 7.5, 50, 27.5),  // 5 from id 7: the gate is inclusive
      segment(10, 7, 50, 27),      // 6
      segment(90, 90, 95, 99),
  };
  EXPECT_EQ(carryOverIds("f", kUnit, detected, truth), (Ids{7, 8, 7, kNoId, kNoId}));
  EXPECT_EQ(carryOverIds("f", kUnit, detected, truth, 6), (Ids{7, 8, 7, 7, kNoId}));
  EXPECT_EQ(carryOverIds("f", kUnit, detected, truth, 1), (Ids(5, kNoId)));
}

TEST(CarryOverIds, TheNearestLineCountsEvenWithoutId) {
  const LineSegments truth = {withId(segment(10, 10, 50, 30), 7), segment(10, 11, 50, 31)};
  EXPECT_EQ(carryOverIds("f", kUnit, {segment(10, 11, 50, 31)}, truth), Ids{kNoId});
  EXPECT_EQ(carryOverIds("f", kUnit, {segment(10, 10, 50, 30)}, truth), Ids{7});
}

TEST(CarryOverIds, MeasuresInTheScaledFrame) {
  // 5 pixels of 640 are one scaled pixel, and there are two ends.
  const LineSegments truth = {withId(segment(100, 100, 300, 200), 3)};
  EXPECT_EQ(carryOverIds("f", {640, 480}, {segment(112, 100, 312, 200)}, truth), Ids{3});
  EXPECT_EQ(carryOverIds("f", {640, 480}, {segment(113, 100, 313, 200)}, truth), Ids{kNoId});
}

TEST(CarryOverIds, NeitherDropsNorClampsLines) {
  const LineSegments truth = {withId(segment(10, 20, 50, 20), 1), withId(segment(-3, 5, 9, 9), 2)};
  EXPECT_EQ(carryOverIds("f", kUnit, {segment(10, 20, 50, 20), segment(-3, 5, 9, 9)}, truth),
            (Ids{1, 2}));
  EXPECT_EQ(carryOverIds("f", kUnit, {}, truth), Ids{});
  EXPECT_EQ(carryOverIds("f", kUnit, {segment(1, 1, 2, 2)}, {}), Ids{kNoId});
}

TEST(CarryOverIds, RefusesBadInput) {
  const LineSegments fine = {segment(1, 1, 2, 2)};
  const LineSegments bad = {fine[0], segment(1, NAN, 2, 2)};
  expectError<GroundTruthError>([&] { carryOverIds("0003", kUnit, fine, bad); },
                                {"0003", "row 1", "1,nan,2,2"});
  expectError([&] { carryOverIds("0003", kUnit, bad, fine); }, {"0003", "row 1", "1,nan,2,2"});
  expectError([&] { carryOverIds("0003", {0, 5}, fine, fine); }, {"0003", "0 x 5"});
  for (const double gate : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    expectError([&] { carryOverIds("0003", kUnit, fine, fine, gate); }, {"gate"});
  }
}

void expectCounts(const DetectedAssociation& counts, std::uint64_t true_pairs,
                  std::uint64_t predicted, std::uint64_t without_truth, std::uint64_t joined,
                  std::uint64_t visible) {
  EXPECT_EQ(counts.true_pairs, true_pairs);
  EXPECT_EQ(counts.predicted_pairs, predicted);
  EXPECT_EQ(counts.pairs_without_truth, without_truth);
  EXPECT_EQ(counts.joined_lines, joined);
  EXPECT_EQ(counts.visible_lines, visible);
}

TEST(ClassifyDetectedAssociation, JudgesPairsAndCountsPhysicalLines) {
  // Lines 4 and 5 are visible in both; 6 in the first alone, 9 in the second alone.
  const Ids first = {4, 5, 6, kNoId};
  const Ids second = {5, 4, 9, kNoId};
  // Right; wrong; without truth on one side; on both.
  const auto counts = classifyDetectedAssociation({{0, 1}, {1, 2}, {2, 3}, {3, 3}}, first, second);
  expectCounts(counts, 1, 4, 2, 1, 2);
  EXPECT_EQ(counts.precision(), 0.25);
  EXPECT_EQ(counts.recall(), 0.5);
  EXPECT_NEAR(counts.fScore(), 1.0 / 3, 1e-12);
}

TEST(ClassifyDetectedAssociation, LinesWithoutTruthAreNotEqualToEachOther) {
  expectCounts(classifyDetectedAssociation({{0, 0}}, {kNoId}, {kNoId}), 0, 1, 1, 0, 0);
}

TEST(ClassifyDetectedAssociation, PiecesOfOneLineAreOnePhysicalLine) {
  const Ids first = {4, 4, 5};
  const Ids second = {4, 4, 5};
  const auto counts = classifyDetectedAssociation({{0, 1}, {1, 0}}, first, second);
  expectCounts(counts, 2, 2, 0, 1, 2);
  EXPECT_EQ(counts.precision(), 1);
  EXPECT_EQ(counts.recall(), 0.5);
}

TEST(ClassifyDetectedAssociation, RepeatsAreFalse) {
  expectCounts(classifyDetectedAssociation({{0, 0}, {0, 0}, {0, 0}}, {4}, {4}), 1, 3, 0, 1, 1);
}

TEST(ClassifyDetectedAssociation, NothingIsZeroAndNotNaN) {
  const auto counts = classifyDetectedAssociation({}, {}, {});
  EXPECT_EQ(counts.precision(), 0);
  EXPECT_EQ(counts.recall(), 0);
  EXPECT_EQ(counts.fScore(), 0);
}

TEST(ClassifyDetectedAssociation, RefusesRowsThatAreNotThere) {
  for (const IndexPair& pair : {IndexPair{1, 0}, {0, 2}, {-1, 0}, {0, -1}}) {
    expectError(
        [&] {
          classifyDetectedAssociation({pair}, {4}, {4, 5});
        },
        {"(" + std::to_string(pair.first) + ", " + std::to_string(pair.second) + ")"});
  }
}

TEST(ClassifyDetectedAssociation, AgreesWithTheArticlesOnGroundTruthLines) {
  // Detected lines that are the ground truth: the family becomes the article's.
  test::RandomLines random(4);
  LineSegments first = random.anywhere(30, 128, 128);
  for (std::size_t row = 0; row < first.size(); ++row) {
    first[row].id = static_cast<std::int64_t>(row);
  }
  LineSegments second = first;
  random.shuffle(&second);
  second.resize(25);
  IndexPairs predicted;
  for (int count = 0; count < 30; ++count) {
    predicted.emplace_back(random.index(30), random.index(25));
  }
  const IndexPairs truth = pairsOfEqualIds(first, second);
  predicted.insert(predicted.end(), truth.begin(), truth.begin() + 15);
  const Classification expected = classifyAssociation(predicted, truth);
  const auto counts = classifyDetectedAssociation(predicted, carryOverIds("a", kUnit, first, first),
                                                  carryOverIds("b", kUnit, second, second));
  EXPECT_GT(expected.true_positives, 14U);
  EXPECT_EQ(counts.precision(), expected.precision());
  EXPECT_EQ(counts.recall(), expected.recall());
}

TEST(DetectedAssociationMetrics, MergeEqualsAllInOne) {
  const Ids ids = {4, 5};
  DetectedAssociationMetrics all;
  DetectedAssociationMetrics part;
  all.addPair({{0, 0}}, ids, ids);
  all.addPair({{0, 1}, {1, 1}}, ids, ids);
  part.addPair({{0, 1}, {1, 1}}, ids, ids);
  DetectedAssociationMetrics merged;
  EXPECT_EQ(merged.addPair({{0, 0}}, ids, ids).joined_lines, 1U);
  merged.merge(part);
  expectCounts(merged.classification(), 2, 3, 0, 2, 4);
  expectCounts(all.classification(), 2, 3, 0, 2, 4);
  EXPECT_EQ(merged.pairs(), 2U);
  merged.merge(merged);
  expectCounts(merged.classification(), 4, 6, 0, 4, 8);
  merged.reset();
  expectCounts(merged.classification(), 0, 0, 0, 0, 0);
  EXPECT_EQ(merged.pairs(), 0U);
}

TEST(DetectedAssociationMetrics, AddsNothingOfARefusedPair) {
  DetectedAssociationMetrics metrics;
  EXPECT_THROW(metrics.addPair({{0, 0}, {5, 5}}, {1}, {1}), Error);
  EXPECT_EQ(metrics.pairs(), 0U);
  expectCounts(metrics.classification(), 0, 0, 0, 0, 0);
}

}  // namespace
}  // namespace evolin
