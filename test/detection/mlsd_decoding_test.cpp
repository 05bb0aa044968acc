// M-LSD's decoding: from maps that are made here, from damaged ones, and from the golden ones.
#include "mlsd_decoding.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <tuple>

#include "evolin_ros/base/error.h"
#include "test/detection/network_golden.h"

namespace evolin::mlsd {
namespace {

constexpr float kNone = -20;  // a logit whose probability is nothing

/// Maps [5, rows, columns] without a centre.
cv::Mat emptyMaps(int rows, int columns) {
  const std::array<int, 3> shape{5, rows, columns};
  cv::Mat maps(3, shape.data(), CV_32F, cv::Scalar(0));
  maps.row(0).setTo(kNone);
  return maps;
}

void put(cv::Mat* maps, int x, int y, const std::array<float, 5>& values) {
  for (int c = 0; c < 5; ++c) {
    maps->at<float>(c, y, x) = values[static_cast<std::size_t>(c)];
  }
}

TEST(MlsdDecoding, ACentreAndItsDisplacementsAreALine) {
  cv::Mat maps = emptyMaps(16, 16);
  put(&maps, 5, 6, {0, -3, -1, 4, 2});
  const LineSegments lines = Decoder({}).decode(maps, cv::Size(64, 32));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_DOUBLE_EQ(lines[0].x1, (5 - 3) * 4);
  EXPECT_DOUBLE_EQ(lines[0].y1, (6 - 1) * 2);
  EXPECT_DOUBLE_EQ(lines[0].x2, (5 + 4) * 4);
  EXPECT_DOUBLE_EQ(lines[0].y2, (6 + 2) * 2);
  EXPECT_DOUBLE_EQ(lines[0].score, 0.5);
}

TEST(MlsdDecoding, LinesComeByFallingScoreAndMayLeaveTheImage) {
  cv::Mat maps = emptyMaps(16, 16);
  put(&maps, 1, 1, {1, -5, 0, 5, 0});
  put(&maps, 9, 9, {2, -5, 0, 15, 0});
  put(&maps, 1, 9, {0, -5, 0, 5, 0});
  const LineSegments lines = Decoder({}).decode(maps, cv::Size(16, 16));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_DOUBLE_EQ(lines[0].x2, 24);
  EXPECT_DOUBLE_EQ(lines[1].x1, -4);
  EXPECT_GT(lines[0].score, lines[1].score);
  EXPECT_GT(lines[1].score, lines[2].score);
}

TEST(MlsdDecoding, OnlyTheGreatestOfNineNeighboursIsACentre) {
  cv::Mat maps = emptyMaps(16, 16);
  put(&maps, 5, 5, {1, -3, 0, 3, 0});
  put(&maps, 6, 6, {2, -4, 0, 4, 0});
  put(&maps, 8, 6, {1, -5, 0, 5, 0});
  const LineSegments lines = Decoder({}).decode(maps, cv::Size(16, 16));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_DOUBLE_EQ(lines[0].length(), 8);
  EXPECT_DOUBLE_EQ(lines[1].length(), 10);
}

// 20 and 30 have the same probability in single precision: 1.
TEST(MlsdDecoding, MaximaAreOfProbabilitiesSoThatSaturatedNeighboursBothStay) {
  cv::Mat maps = emptyMaps(16, 16);
  put(&maps, 5, 5, {20, -3, 0, 3, 0});
  put(&maps, 6, 5, {30, -4, 0, 4, 0});
  const LineSegments lines = Decoder({}).decode(maps, cv::Size(16, 16));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_DOUBLE_EQ(lines[0].length(), 6) << "of equal scores the earlier pixel comes first";
}

TEST(MlsdDecoding, ThresholdsAreStrict) {
  cv::Mat maps = emptyMaps(8, 8);
  put(&maps, 3, 3, {0, -1, 0, 1, 0});
  DecodingOptions options;
  options.min_grid_length = 2;
  EXPECT_TRUE(Decoder(options).decode(maps, cv::Size(8, 8)).empty());
  options.min_grid_length = 1.99;
  EXPECT_EQ(Decoder(options).decode(maps, cv::Size(8, 8)).size(), 1U);
  options.score_threshold = 0.5;
  EXPECT_TRUE(Decoder(options).decode(maps, cv::Size(8, 8)).empty());
  options.score_threshold = 0.4999;
  EXPECT_EQ(Decoder(options).decode(maps, cv::Size(8, 8)).size(), 1U);
}

TEST(MlsdDecoding, CandidatesAreChosenBeforeTheLengthIsLookedAt) {
  cv::Mat maps = emptyMaps(16, 16);
  put(&maps, 3, 3, {2, 0, 0, 1, 0});
  put(&maps, 9, 9, {1, -3, 0, 3, 0});
  DecodingOptions options;
  options.candidates = 1;
  EXPECT_TRUE(Decoder(options).decode(maps, cv::Size(16, 16)).empty());
  options.candidates = 2;
  EXPECT_EQ(Decoder(options).decode(maps, cv::Size(16, 16)).size(), 1U);
}

TEST(MlsdDecoding, EmptyMapsHaveNoLines) {
  EXPECT_TRUE(Decoder({}).decode(emptyMaps(8, 8), cv::Size(640, 480)).empty());
}

TEST(MlsdDecoding, OtherTensorsAreErrors) {
  Decoder decoder({});
  EXPECT_THROW(decoder.decode(cv::Mat(), cv::Size(8, 8)), Error);
  EXPECT_THROW(decoder.decode(cv::Mat(8, 8, CV_32F), cv::Size(8, 8)), Error);
  const std::array<int, 3> four{4, 8, 8};
  EXPECT_THROW(decoder.decode(cv::Mat(3, four.data(), CV_32F), cv::Size(8, 8)), Error);
  const std::array<int, 4> two{2, 5, 8, 8};
  EXPECT_THROW(decoder.decode(cv::Mat(4, two.data(), CV_32F), cv::Size(8, 8)), Error);
  const std::array<int, 3> whole{5, 8, 8};
  EXPECT_THROW(decoder.decode(cv::Mat(3, whole.data(), CV_32S), cv::Size(8, 8)), Error);
}

TEST(MlsdDecoding, NotANumberAndInfinityNeverBecomeLines) {
  std::mt19937 random(7);
  const std::array<float, 6> odd = {
      std::numeric_limits<float>::quiet_NaN(),  std::numeric_limits<float>::infinity(),
      -std::numeric_limits<float>::infinity(),  std::numeric_limits<float>::max(),
      std::numeric_limits<float>::denorm_min(), 1.0F};
  DecodingOptions all;
  all.score_threshold = -1;
  all.min_grid_length = 0;
  std::size_t found = 0;
  for (int round = 0; round < 200; ++round) {
    cv::Mat maps = emptyMaps(9, 7);
    float* values = maps.ptr<float>();
    for (std::size_t i = 0; i < maps.total(); ++i) {
      values[i] = random() % 3 == 0 ? odd[random() % odd.size()]
                                    : static_cast<float>(random() % 2000) / 100 - 10;
    }
    for (const DecodingOptions& options : {DecodingOptions(), all}) {
      for (const LineSegment& line : Decoder(options).decode(maps, cv::Size(640, 480))) {
        ASSERT_TRUE(line.isFinite());
        ASSERT_TRUE(line.score >= 0 && line.score <= 1);
        ++found;
      }
    }
  }
  EXPECT_GT(found, 100U) << "hardly any line among the damage";
  cv::Mat maps = emptyMaps(8, 8);
  maps.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(Decoder(all).decode(maps, cv::Size(640, 480)).empty());
}

/// Golden set, and what it was decoded with.
using GoldenSet = std::tuple<std::string, double, double>;

class MlsdGoldenDecoding : public ::testing::TestWithParam<GoldenSet> {};

TEST_P(MlsdGoldenDecoding, StoredMapsGiveTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto& [set, score_threshold, min_length] = GetParam();
  DecodingOptions options;
  options.score_threshold = score_threshold;
  options.min_grid_length = min_length;
  Decoder decoder(options);
  const std::string network = set.substr(0, set.find('/'));
  for (int frame = 0; frame < test::kGoldenMaps; ++frame) {
    const cv::Mat maps = test::readNpy(test::networkFolder() / network / "tpmap" /
                                       (test::goldenStem(frame) + ".npy"));
    SCOPED_TRACE(frame);
    test::expectSameLines(decoder.decode(maps, cv::Size(640, 480)), test::networkLines(set, frame),
                          1e-3, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, MlsdGoldenDecoding,
                         ::testing::Values(GoldenSet{"mlsd_tiny_512/evolin", 0.01, 2.0},
                                           GoldenSet{"mlsd_tiny_512/default", 0.1, 20.0},
                                           GoldenSet{"mlsd_tiny_320/evolin", 0.01, 2.0},
                                           GoldenSet{"mlsd_tiny_320/default", 0.1, 20.0}));

}  // namespace
}  // namespace evolin::mlsd
