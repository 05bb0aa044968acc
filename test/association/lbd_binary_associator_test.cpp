// The plug-ins lbd_binary and opencv_lbd_binary: robustness, their cache and shipped parameters.
// Real frames are lbd_binary_golden_test.cpp's.
#include "evolin_ros/association/lbd_binary_associator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/association/descriptor_choice_support.h"
#include "test/association/textured_images.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

using test::reversed;
using test::segment;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FrameLines texturedFrame(const LineSegments& lines) {
  FrameLines frame;
  frame.frame.name = "drawn";
  frame.frame.image = test::texture(200, 240);
  frame.lines = lines;
  return frame;
}

LineSegments someLines() {
  return {segment(50, 50, 150, 60), segment(60, 150, 170, 120), segment(120, 40, 110, 160),
          segment(40, 40, 60, 150)};
}

std::vector<std::tuple<std::uint32_t, std::uint32_t, float>> rows(const LineMatches& matches) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, float>> result;
  for (const LineMatch& match : matches) {
    result.emplace_back(match.first, match.second, match.distance);
  }
  return result;
}

void expectIdentity(const LineMatches& matches, std::size_t count) {
  ASSERT_EQ(matches.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(matches[i].first, i);
    EXPECT_EQ(matches[i].second, i);
    EXPECT_EQ(matches[i].distance, 0.0F);
  }
}

template <typename Associator>
class LbdBinaryAssociatorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!associator_.whyUnavailable().empty()) {
      GTEST_SKIP() << associator_.whyUnavailable();
    }
    associator_.configure(YAML::Node());
  }

  LineMatches match(const FrameLines& first, const FrameLines& second) {
    return associator_.match(first, second);
  }

  Associator associator_;
  const std::string name_ =
      std::is_same_v<Associator, LbdBinaryAssociator> ? "lbd_binary" : "opencv_lbd_binary";
};

using Associators = ::testing::Types<LbdBinaryAssociator, OpenCvLbdBinaryAssociator>;
TYPED_TEST_SUITE(LbdBinaryAssociatorTest, Associators);

TYPED_TEST(LbdBinaryAssociatorTest, PairsEqualFramesLineByLineAtDistanceZero) {
  expectIdentity(this->match(texturedFrame(someLines()), texturedFrame(someLines())), 4);
}

TYPED_TEST(LbdBinaryAssociatorTest, FollowsAPermutationOfTheLines) {
  test::RandomLines random(8);
  const LineSegments lines = random.anywhere(60, 239, 199);
  std::vector<std::uint32_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0U);
  random.shuffle(&order);
  LineSegments shuffled;
  for (const std::uint32_t i : order) {
    shuffled.push_back(lines[i]);
  }
  const LineMatches straight = this->match(texturedFrame(lines), texturedFrame(lines));
  ASSERT_EQ(straight.size(), lines.size());
  const LineMatches matches = this->match(texturedFrame(lines), texturedFrame(shuffled));
  ASSERT_EQ(matches.size(), lines.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_EQ(matches[i].first, i);
    EXPECT_EQ(order[matches[i].second], i);
    EXPECT_EQ(matches[i].distance, 0.0F);
  }
}

TYPED_TEST(LbdBinaryAssociatorTest, TakesTheEndpointsInTheOrderGiven) {
  LineSegments lines = someLines();
  lines[2] = reversed(lines[2]);
  const LineMatches matches = this->match(texturedFrame(someLines()), texturedFrame(lines));
  const auto zeros = std::count_if(matches.begin(), matches.end(),
                                   [](const LineMatch& match) { return match.distance == 0; });
  EXPECT_EQ(zeros, 3);
  expectIdentity(this->match(texturedFrame(lines), texturedFrame(lines)), 4);
}

TYPED_TEST(LbdBinaryAssociatorTest, LeavesLinesWithoutLengthPlaceOrTextureUnmatched) {
  LineSegments lines = someLines();
  lines.insert(lines.begin(), segment(90, 90, 90, 90));
  lines.push_back(segment(kNan, 1, 2, 3));
  lines.push_back(segment(500, 1, 600, 3));
  lines.push_back(segment(90, 90, 90, 90));
  const LineMatches matches = this->match(texturedFrame(lines), texturedFrame(lines));
  ASSERT_EQ(matches.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(matches[i].first, i + 1);
    EXPECT_EQ(matches[i].second, i + 1);
  }
  FrameLines flat = texturedFrame(someLines());
  flat.frame.image = cv::Mat(200, 240, CV_8UC1, cv::Scalar(77));
  EXPECT_TRUE(this->match(flat, flat).empty());
  EXPECT_TRUE(this->match(flat, texturedFrame(someLines())).empty());
}

TYPED_TEST(LbdBinaryAssociatorTest, MatchesNothingToNothing) {
  const FrameLines none = texturedFrame({});
  const FrameLines some = texturedFrame(someLines());
  EXPECT_TRUE(this->match(none, some).empty());
  EXPECT_TRUE(this->match(some, none).empty());
  EXPECT_TRUE(this->match(none, none).empty());
  FrameLines pixel = texturedFrame(someLines());
  pixel.frame.image = cv::Mat(1, 1, CV_8UC1, cv::Scalar(9));
  pixel.lines.push_back(segment(-1, 0, 1, 0));
  EXPECT_TRUE(this->match(pixel, some).empty());
}

TYPED_TEST(LbdBinaryAssociatorTest, SaysNothingOnStandardOutput) {
  ::testing::internal::CaptureStdout();
  FrameLines flat = texturedFrame({segment(kNan, 1, 2, 3)});
  this->match(flat, texturedFrame({}));
  this->match(flat, texturedFrame(someLines()));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TYPED_TEST(LbdBinaryAssociatorTest, DescribesAFrameOnce) {
  FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(someLines());
  const LineMatches before = this->match(first, second);
  ASSERT_TRUE(first.description.has_value());
  first.frame.image = cv::Mat();  // a second description would have to throw
  LineMatches after;
  ASSERT_NO_THROW(after = this->match(first, second));
  EXPECT_EQ(rows(after), rows(before));
}

TYPED_TEST(LbdBinaryAssociatorTest, ReplacesAnotherMethodsCacheAndOneOfOtherLines) {
  FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(someLines());
  first.description = std::string("another method's");
  EXPECT_EQ(this->match(first, second).size(), 4U);
  first.lines.pop_back();
  EXPECT_EQ(this->match(first, second).size(), 3U);
}

TYPED_TEST(LbdBinaryAssociatorTest, KeepsOneSidedPairsOnlyWithoutCrossCheck) {
  LineSegments doubled = someLines();
  doubled.push_back(doubled.front());
  const FrameLines first = texturedFrame(doubled);
  const FrameLines second = texturedFrame(someLines());
  EXPECT_EQ(this->match(first, second).size(), 4U);
  TypeParam one_sided;
  one_sided.configure(YAML::Load("{cross_check: false}"));
  EXPECT_EQ(one_sided.match(first, second).size(), 5U);
}

TYPED_TEST(LbdBinaryAssociatorTest, DropsPairsBeyondTheLargestDistance) {
  LineSegments moved = someLines();
  for (LineSegment& line : moved) {
    line.y1 += 1;
    line.y2 += 1;
  }
  const FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(moved);
  const LineMatches all = this->match(first, second);
  ASSERT_EQ(all.size(), 4U);
  std::vector<float> distances;
  for (const LineMatch& match : all) {
    distances.push_back(match.distance);
  }
  std::sort(distances.begin(), distances.end());
  ASSERT_GT(distances.back(), distances.front());
  for (const float limit : {distances.front(), distances.back()}) {
    TypeParam strict;
    strict.configure(YAML::Load("{max_distance: " + std::to_string(int(limit)) + "}"));
    for (const LineMatch& match : strict.match(first, second)) {
      EXPECT_LE(match.distance, limit);
    }
  }
  TypeParam strict;
  strict.configure(YAML::Load("{max_distance: " + std::to_string(int(distances.back()) - 1) + "}"));
  const LineMatches fewer = strict.match(first, second);
  EXPECT_LT(fewer.size(), 4U);
  EXPECT_GE(fewer.size(), 1U);
}

TYPED_TEST(LbdBinaryAssociatorTest, GivesTheSamePairsWhenTheFramesAreExchanged) {
  test::RandomLines random(9);
  const FrameLines first = texturedFrame(random.anywhere(60, 239, 199));
  FrameLines second = texturedFrame(random.anywhere(70, 239, 199));
  std::copy_n(first.lines.begin(), 30, second.lines.begin() + 20);
  TypeParam strict;
  strict.configure(YAML::Load("{max_ratio: 0.95, max_displacement: 90, max_angle: 40}"));
  for (LineAssociator* associator :
       {static_cast<LineAssociator*>(&this->associator_), static_cast<LineAssociator*>(&strict)}) {
    std::set<std::tuple<std::uint32_t, std::uint32_t, float>> back;
    for (const LineMatch& match : associator->match(second, first)) {
      back.emplace(match.second, match.first, match.distance);
    }
    const auto there = rows(associator->match(first, second));
    EXPECT_GE(there.size(), 20U);
    for (const auto& row : there) {
      EXPECT_EQ(back.count(row), 1U) << std::get<0>(row) << " - " << std::get<1>(row);
    }
    EXPECT_EQ(there.size(), back.size());
  }
}

TYPED_TEST(LbdBinaryAssociatorTest, RefusesBadParametersOtherImagesAndUseBeforeConfigure) {
  TypeParam fresh;
  EXPECT_THROW(fresh.match(texturedFrame(someLines()), texturedFrame(someLines())), Error);
  for (const char* bad :
       {"{crosscheck: true}", "{max_distance: 257}", "{max_distance: -1}", "{max_distance: near}",
        "{cross_check: 3}", "{max_ratio: 1.1}", "{max_displacement: -1}", "{max_angle: 91}"}) {
    EXPECT_THROW(fresh.configure(YAML::Load(bad)), ConfigError) << bad;
  }
  FrameLines deep = texturedFrame(someLines());
  deep.frame.image.convertTo(deep.frame.image, CV_16U);
  try {
    this->match(deep, texturedFrame(someLines()));
    FAIL() << "a 16-bit image was taken";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("associator " + this->name_), std::string::npos) << message;
    EXPECT_NE(message.find("'drawn'"), std::string::npos) << message;
  }
}

TYPED_TEST(LbdBinaryAssociatorTest, ShippedFileHoldsAllDefaults) {
  const std::filesystem::path file =
      std::filesystem::path(EVOLIN_SOURCE_DIR) / "config" / "associators" / (this->name_ + ".yaml");
  const YAML::Node node = YAML::LoadFile(file.string());
  TypeParam loaded;
  ASSERT_NO_THROW(loaded.configure(node));
  test::expectHoldsAllDefaults(node, loaded.parameters(), TypeParam().parameters());
}

TYPED_TEST(LbdBinaryAssociatorTest, MatchesHundredsOfRandomAndBrokenLinesOnce) {
  test::RandomLines random(21);
  LineSegments lines = random.anywhere(400, 700, 600);  // most reach beyond the image
  for (std::size_t i = 0; i < lines.size(); i += 7) {
    lines[i].x1 = kNan;
  }
  const LineMatches matches = this->match(texturedFrame(lines), texturedFrame(lines));
  std::set<std::uint32_t> seconds;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_TRUE(i == 0 || matches[i - 1].first < matches[i].first);
    EXPECT_NE(matches[i].first % 7, 0U);
    EXPECT_TRUE(seconds.insert(matches[i].second).second);
  }
  EXPECT_GE(matches.size(), 50U);
}

// Each thread with its own instance and frames, against the same work done one after the other.
TYPED_TEST(LbdBinaryAssociatorTest, TwoInstancesDoNotDisturbEachOther) {
  struct Work {
    LineSegments lines;
    cv::Mat image;
    std::vector<LineMatches> results;

    void run() {
      TypeParam associator;
      associator.configure(YAML::Node());
      for (int round = 0; round < 10; ++round) {
        FrameLines first;
        first.frame.image = image;
        first.lines = lines;
        FrameLines second = first;
        for (LineSegment& line : second.lines) {
          line.x1 += 0.5 * round;
          line.x2 += 0.5 * round;
        }
        results.push_back(associator.match(first, second));
      }
    }
  };
  Work alone[2];
  Work together[2];
  for (int i = 0; i < 2; ++i) {
    alone[i].image = together[i].image = test::texture(200 + 100 * i, 300 - 50 * i, 5 + 3 * i);
    alone[i].lines = together[i].lines = test::RandomLines(i).anywhere(80, 250, 200);
    alone[i].run();
  }
  std::thread other([&together] { together[1].run(); });
  together[0].run();
  other.join();
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(together[i].results.size(), alone[i].results.size());
    for (std::size_t k = 0; k < alone[i].results.size(); ++k) {
      EXPECT_GE(alone[i].results[k].size(), 30U);
      EXPECT_EQ(rows(together[i].results[k]), rows(alone[i].results[k])) << "round " << k;
    }
  }
}

TEST(LbdBinaryAgainstOpenCv, DoesNotTakeTheOthersDescriptions) {
  OpenCvLbdBinaryAssociator opencv;
  if (!opencv.whyUnavailable().empty()) {
    GTEST_SKIP() << opencv.whyUnavailable();
  }
  LbdBinaryAssociator own;
  own.configure(YAML::Node());
  opencv.configure(YAML::Node());
  // At the border the two differ.
  FrameLines frame = texturedFrame({segment(1, 50, 1, 150), segment(60, 2, 170, 2)});
  own.describe(frame);
  frame.frame.image.release();
  EXPECT_THROW(opencv.describe(frame), Error);
}

}  // namespace
}  // namespace evolin
