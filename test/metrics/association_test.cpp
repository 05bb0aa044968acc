// Association as classification of index pairs.
#include "evolin_ros/metrics/association.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

LineSegments withIds(const std::vector<std::int64_t>& ids) {
  LineSegments lines(ids.size());
  for (std::size_t row = 0; row < ids.size(); ++row) {
    lines[row].id = ids[row];
  }
  return lines;
}

TEST(PairsOfEqualIds, JoinRowsOfTheSameLine) {
  const IndexPairs expected = {{0, 2}, {2, 0}};
  EXPECT_EQ(pairsOfEqualIds(withIds({7, 8, 5}), withIds({5, 9, 7})), expected);
}

TEST(PairsOfEqualIds, NegativeIdsBelongToNobody) {
  EXPECT_TRUE(pairsOfEqualIds(withIds({-1, -2, kNoId}), withIds({-1, -2, kNoId})).empty());
}

TEST(PairsOfEqualIds, RepeatedIdIsAnErrorWithItsRow) {
  try {
    pairsOfEqualIds(withIds({4, 1, 4}), withIds({}));
    FAIL() << "accepted in the first frame";
  } catch (const GroundTruthError& error) {
    EXPECT_EQ(error.row(), 2U);
  }
  EXPECT_THROW(pairsOfEqualIds(withIds({}), withIds({3, 3})), GroundTruthError);
}

TEST(ClassifyAssociation, CountsTruePairs) {
  const Classification counts =
      classifyAssociation({{0, 0}, {1, 2}, {3, 3}}, {{3, 3}, {0, 0}, {1, 1}, {2, 2}});
  EXPECT_EQ(counts.true_positives, 2U);
  EXPECT_EQ(counts.predicted, 3U);
  EXPECT_EQ(counts.ground_truth, 4U);
}

TEST(ClassifyAssociation, PairsAreOrdered) {
  EXPECT_EQ(classifyAssociation({{1, 2}}, {{2, 1}}).true_positives, 0U);
}

TEST(ClassifyAssociation, RepeatsAreFalsePositives) {
  const Classification counts = classifyAssociation({{1, 1}, {1, 1}, {1, 1}}, {{1, 1}});
  EXPECT_EQ(counts.true_positives, 1U);
  EXPECT_EQ(counts.predicted, 3U);
}

TEST(ClassifyAssociation, RepeatedTruePairsAreMisses) {
  const Classification counts = classifyAssociation({{1, 1}}, {{1, 1}, {1, 1}});
  EXPECT_EQ(counts.true_positives, 1U);
  EXPECT_EQ(counts.ground_truth, 2U);
}

TEST(ClassifyAssociation, IsPerfectOnItselfInAnyOrder) {
  test::RandomLines random(3);
  IndexPairs pairs;
  for (std::int64_t row = 0; row < 50; ++row) {
    pairs.emplace_back(row, 49 - row);
  }
  IndexPairs shuffled = pairs;
  random.shuffle(&shuffled);
  const Classification counts = classifyAssociation(shuffled, pairs);
  EXPECT_EQ(counts.precision(), 1);
  EXPECT_EQ(counts.recall(), 1);
  EXPECT_EQ(counts.fScore(), 1);
}

TEST(ClassifyAssociation, IsBlindToTheOrderOfPairs) {
  test::RandomLines random(4);
  for (int round = 0; round < 20; ++round) {
    IndexPairs truth;
    IndexPairs predicted;
    for (std::int64_t row = 0; row < 30; ++row) {
      truth.emplace_back(row, row);
      predicted.emplace_back(row, static_cast<std::int64_t>(random.index(3)) == 0 ? row + 1 : row);
    }
    const Classification expected = classifyAssociation(predicted, truth);
    random.shuffle(&truth);
    random.shuffle(&predicted);
    const Classification counts = classifyAssociation(predicted, truth);
    EXPECT_EQ(counts.true_positives, expected.true_positives);
    EXPECT_EQ(counts.predicted, expected.predicted);
    EXPECT_EQ(counts.ground_truth, expected.ground_truth);
    EXPECT_GT(expected.true_positives, 0U);
    EXPECT_LT(expected.true_positives, 30U);
  }
}

TEST(ClassifyAssociation, NothingIsZeroAndNotNaN) {
  for (const Classification& counts :
       {classifyAssociation({}, {}), classifyAssociation({{0, 0}}, {}),
        classifyAssociation({}, {{0, 0}}), AssociationMetrics().classification()}) {
    EXPECT_EQ(counts.precision(), 0);
    EXPECT_EQ(counts.recall(), 0);
    EXPECT_EQ(counts.fScore(), 0);
  }
}

TEST(AssociationMetrics, SumsPairsAndReturnsEachOnes) {
  AssociationMetrics metrics;
  EXPECT_EQ(metrics.addPair({{0, 0}}, {{0, 0}}).true_positives, 1U);
  EXPECT_EQ(metrics.addPair({}, {{0, 0}, {1, 1}}).ground_truth, 2U);
  EXPECT_EQ(metrics.pairs(), 2U);
  EXPECT_DOUBLE_EQ(metrics.classification().precision(), 1);
  EXPECT_DOUBLE_EQ(metrics.classification().recall(), 1.0 / 3);
}

TEST(AssociationMetrics, MergeEqualsAllInOne) {
  AssociationMetrics all;
  AssociationMetrics first;
  AssociationMetrics second;
  all.addPair({{0, 0}, {1, 1}}, {{0, 0}});
  all.addPair({{2, 2}}, {{2, 2}, {3, 3}});
  first.addPair({{0, 0}, {1, 1}}, {{0, 0}});
  second.addPair({{2, 2}}, {{2, 2}, {3, 3}});
  second.merge(first);
  EXPECT_EQ(second.pairs(), all.pairs());
  EXPECT_EQ(second.classification().true_positives, all.classification().true_positives);
  EXPECT_EQ(second.classification().predicted, all.classification().predicted);
  EXPECT_EQ(second.classification().ground_truth, all.classification().ground_truth);
}

TEST(AssociationMetrics, ResetForgetsEverything) {
  AssociationMetrics metrics;
  metrics.addPair({{0, 0}}, {{0, 0}});
  metrics.reset();
  EXPECT_EQ(metrics.pairs(), 0U);
  EXPECT_EQ(metrics.classification().predicted, 0U);
}

TEST(AssociationMetrics, MatchesBecomePairs) {
  const IndexPairs expected = {{4, 2}, {0, 1}};
  EXPECT_EQ(toIndexPairs({{4, 2, 0.5F}, {0, 1}}), expected);
}

}  // namespace
}  // namespace evolin
