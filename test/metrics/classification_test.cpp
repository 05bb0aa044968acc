// Precision, recall, F-score from counts; names of the protocols.
#include "evolin_ros/metrics/classification.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "evolin_ros/metrics/protocol.h"

namespace evolin {
namespace {

TEST(Classification, GivesTheUsualRatios) {
  const Classification counts{6, 8, 12};
  EXPECT_DOUBLE_EQ(counts.precision(), 0.75);
  EXPECT_DOUBLE_EQ(counts.recall(), 0.5);
  EXPECT_DOUBLE_EQ(counts.fScore(), 0.6);
}

TEST(Classification, IsZeroWhereUndefined) {
  const Classification nothing;
  EXPECT_EQ(nothing.precision(), 0);
  EXPECT_EQ(nothing.recall(), 0);
  EXPECT_EQ(nothing.fScore(), 0);
  const Classification no_truth{0, 4, 0};
  EXPECT_EQ(no_truth.recall(), 0);
  EXPECT_EQ(no_truth.fScore(), 0);
}

TEST(Classification, SumsCountsNotRatios) {
  Classification counts{1, 1, 1};
  counts += Classification{0, 3, 1};
  EXPECT_DOUBLE_EQ(counts.precision(), 0.25);
  EXPECT_DOUBLE_EQ(counts.recall(), 0.5);
}

TEST(Classification, TimesNEqualsNCopiesAdded) {
  const Classification one{2, 3, 5};
  const Classification three = one * 3;
  EXPECT_EQ(three.true_positives, 6U);
  EXPECT_EQ(three.predicted, 9U);
  EXPECT_EQ(three.ground_truth, 15U);
}

TEST(Protocol, NamesGoBothWays) {
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    EXPECT_EQ(parseProtocol(toString(protocol)), protocol);
  }
}

TEST(Protocol, UnknownNameIsRefusedWithTheChoice) {
  try {
    parseProtocol("article");
    FAIL() << "accepted";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'article'"), std::string::npos) << message;
    EXPECT_NE(message.find("evolin or paper"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace evolin
