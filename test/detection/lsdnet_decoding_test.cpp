// LSDNet's decoding: from maps that are made here, from damaged ones, and from the golden ones.
#include "lsdnet_decoding.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "evolin_ros/base/error.h"
#include "test/detection/network_golden.h"

namespace evolin::lsdnet {
namespace {

cv::Mat emptyMaps(int rows = 288, int columns = 288) {
  const std::array<int, 3> shape{rows, columns, 2};
  return cv::Mat(3, shape.data(), CV_32F, cv::Scalar(0));
}

/// A bar of likely pixels with one angle (in half turns).
void draw(cv::Mat* maps, const cv::Rect& bar, float angle, float probability = 0.9F) {
  for (int y = bar.y; y < bar.y + bar.height; ++y) {
    for (int x = bar.x; x < bar.x + bar.width; ++x) {
      maps->at<float>(y, x, 0) = probability;
      maps->at<float>(y, x, 1) = angle;
    }
  }
}

LineSegments decode(const cv::Mat& maps, bool compatible = false, bool single_pass = false) {
  return Decoder({compatible, single_pass}).decode(maps, cv::Size(maps.size[1], maps.size[0]));
}

TEST(LsdNetDecoding, ABarIsALineAlongIt) {
  cv::Mat maps = emptyMaps();
  draw(&maps, {20, 30, 40, 2}, 0);
  const LineSegments lines = decode(maps);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_DOUBLE_EQ(std::min(lines[0].x1, lines[0].x2), 20);
  EXPECT_DOUBLE_EQ(std::max(lines[0].x1, lines[0].x2), 59);
  EXPECT_NEAR(lines[0].y1, 30, 1);
  EXPECT_NEAR(lines[0].score, 0.9, 1e-6);
}

TEST(LsdNetDecoding, OneRowAndOneColumnAreLinesUnlessTheAuthorsAxesAreKept) {
  for (const cv::Rect& bar : {cv::Rect(20, 30, 40, 1), cv::Rect(20, 30, 1, 40)}) {
    cv::Mat maps = emptyMaps();
    draw(&maps, bar, 0.25F);
    const LineSegments mended = decode(maps);
    ASSERT_EQ(mended.size(), 1U);
    EXPECT_NEAR(mended[0].length(), 39, 1e-9);
    const LineSegments compatible = decode(maps, true);
    EXPECT_FALSE(compatible.empty());
    for (const LineSegment& line : compatible) {
      EXPECT_EQ(line.length(), 0);
    }
  }
}

TEST(LsdNetDecoding, ALineAcrossTwoQuartersIsOne) {
  for (const cv::Rect& bar : {cv::Rect(100, 60, 100, 2), cv::Rect(60, 100, 2, 100)}) {
    cv::Mat maps = emptyMaps();
    draw(&maps, bar, 0.5F);
    for (const bool single_pass : {false, true}) {
      const LineSegments lines = decode(maps, false, single_pass);
      ASSERT_EQ(lines.size(), 1U) << bar << single_pass;
      EXPECT_GE(lines[0].length(), 98) << bar << single_pass;
    }
  }
}

// Nothing is joined around more than one corner at a time: two lines of three quarters each.
TEST(LsdNetDecoding, ALineOnTheBorderOfAllQuartersComesTwiceAsWithTheAuthors) {
  for (const cv::Rect& bar : {cv::Rect(100, 143, 100, 2), cv::Rect(143, 100, 2, 100)}) {
    cv::Mat maps = emptyMaps();
    draw(&maps, bar, 0.5F);
    const LineSegments lines = decode(maps);
    EXPECT_EQ(lines.size(), 2U) << bar;
    for (const LineSegment& line : lines) {
      EXPECT_GE(line.length(), 98) << bar;
    }
    EXPECT_EQ(decode(maps, false, true).size(), 1U) << bar;
  }
}

TEST(LsdNetDecoding, NeighboursOfOtherDirectionOrProbabilityAreOtherLines) {
  cv::Mat maps = emptyMaps();
  draw(&maps, {20, 30, 40, 2}, 0);
  draw(&maps, {60, 30, 40, 2}, 0.3F);
  EXPECT_EQ(decode(maps).size(), 2U);
  draw(&maps, {60, 30, 40, 2}, 0, 0.45F);
  EXPECT_EQ(decode(maps).size(), 2U);
  draw(&maps, {60, 30, 40, 2}, 0, 0.8F);
  EXPECT_EQ(decode(maps).size(), 1U);
}

TEST(LsdNetDecoding, RegionsOfTenPixelsAreLeftOut) {
  cv::Mat maps = emptyMaps();
  draw(&maps, {20, 30, 10, 1}, 0);
  EXPECT_TRUE(decode(maps).empty());
  draw(&maps, {20, 30, 11, 1}, 0);
  EXPECT_EQ(decode(maps).size(), 1U);
}

TEST(LsdNetDecoding, ImprobablePixelsAreLeftOut) {
  cv::Mat maps = emptyMaps();
  draw(&maps, {20, 30, 40, 2}, 0, 0.4F);
  EXPECT_TRUE(decode(maps).empty());
}

TEST(LsdNetDecoding, OtherTensorsAreErrors) {
  Decoder decoder({});
  EXPECT_THROW(decoder.decode(cv::Mat(), cv::Size(8, 8)), Error);
  EXPECT_THROW(decoder.decode(cv::Mat(8, 8, CV_32FC2), cv::Size(8, 8)), Error);
  EXPECT_THROW(decoder.decode(emptyMaps(3, 8), cv::Size(8, 8)), Error);
  const std::array<int, 3> three{8, 8, 3};
  EXPECT_THROW(decoder.decode(cv::Mat(3, three.data(), CV_32F), cv::Size(8, 8)), Error);
  EXPECT_NO_THROW(decoder.decode(emptyMaps(4, 4), cv::Size(8, 8)));
}

TEST(LsdNetDecoding, NotANumberAndInfinityNeverBecomeLines) {
  std::mt19937 random(11);
  const std::array<float, 6> odd = {
      std::numeric_limits<float>::quiet_NaN(),  std::numeric_limits<float>::infinity(),
      -std::numeric_limits<float>::infinity(),  std::numeric_limits<float>::max(),
      std::numeric_limits<float>::denorm_min(), -1.0F};
  std::size_t found = 0;
  for (unsigned round = 0; round < 200; ++round) {
    cv::Mat maps = emptyMaps(40, 33);
    for (int bar = 0; bar < 6; ++bar) {
      const int x = static_cast<int>(random() % 20);
      const int y = static_cast<int>(random() % 30);
      draw(&maps, {x, y, 12, 3}, static_cast<float>(random() % 100) / 100,
           0.5F + static_cast<float>(random() % 50) / 100);
    }
    float* values = maps.ptr<float>();
    for (unsigned damage = 0; damage < round; ++damage) {
      values[random() % maps.total()] = odd[random() % odd.size()];
    }
    for (const bool compatible : {false, true}) {
      for (const bool single_pass : {false, true}) {
        for (const LineSegment& line : decode(maps, compatible, single_pass)) {
          ASSERT_TRUE(line.isFinite());
          ASSERT_TRUE(line.x1 >= 0 && line.y1 >= 0 && line.x2 <= 100 && line.y2 <= 100);
          ++found;
        }
      }
    }
  }
  EXPECT_GT(found, 1000U) << "hardly any line among the damage";
  cv::Mat maps = emptyMaps();
  maps.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(decode(maps).empty());
}

/// Regions of all the plane: the most that growing, stitching and splitting may meet.
TEST(LsdNetDecoding, NoiseIsSurvived) {
  std::mt19937 random(3);
  cv::Mat maps = emptyMaps();
  float* values = maps.ptr<float>();
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < maps.total(); ++i) {
      const float share = static_cast<float>(random() % 1000) / 1000;
      values[i] = i % 2 == 0 ? 0.4F + 0.6F * share : 0.05F * static_cast<float>(round) * share;
    }
    for (const LineSegment& line : decode(maps)) {
      ASSERT_TRUE(line.isFinite());
    }
  }
}

struct GoldenSet {
  std::string name;
  bool compatible;
  bool single_pass;
};

class LsdNetGoldenDecoding : public ::testing::TestWithParam<GoldenSet> {};

TEST_P(LsdNetGoldenDecoding, StoredMapsGiveTheGoldenLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const GoldenSet& set = GetParam();
  Decoder decoder({set.compatible, set.single_pass});
  for (int frame = 0; frame < test::kGoldenMaps; ++frame) {
    const cv::Mat maps = test::readNpy(test::networkFolder() / "lsdnet" / "net" /
                                       (test::goldenStem(frame) + ".npy"));
    SCOPED_TRACE(frame);
    test::expectSameLines(decoder.decode(maps, cv::Size(640, 480)),
                          test::networkLines(set.name, frame), 0, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, LsdNetGoldenDecoding,
                         ::testing::Values(GoldenSet{"lsdnet", true, false},
                                           GoldenSet{"lsdnet_axisfix", false, false},
                                           GoldenSet{"lsdnet_single_pass", true, true}));

}  // namespace
}  // namespace evolin::lsdnet
