// Lines of the built-in room, whose true matches are known, found again by where they went.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/association/geometric_associator.h"
#include "evolin_ros/association/lk_tracking_associator.h"
#include "evolin_ros/association/oracle_associator.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "test/association/textured_images.h"

namespace evolin {
namespace {

/// Frames 0, 1, ... of the room with their true lines; rendered once for all tests.
const std::vector<FrameLines>& roomFrames() {
  static const std::vector<FrameLines> frames = [] {
    synthetic::SyntheticOptions options;
    options.frames = 6;
    const synthetic::SyntheticSequence sequence(options);
    std::vector<FrameLines> rendered;
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      const SequenceFrame frame = sequence.frame(i);
      rendered.push_back({frame.frame, *frame.ground_truth, {}});
    }
    return rendered;
  }();
  return frames;
}

struct Shares {
  double precision = 0;
  double recall = 0;
};

/// Of matches against equal ids.
Shares compare(const FrameLines& first, const FrameLines& second, const LineMatches& matches) {
  std::map<std::int64_t, std::size_t> row_of;
  for (std::size_t row = 0; row < second.lines.size(); ++row) {
    row_of[second.lines[row].id] = row;
  }
  double truths = 0;
  for (const LineSegment& line : first.lines) {
    truths += row_of.count(line.id) != 0 ? 1 : 0;
  }
  double right = 0;
  for (const LineMatch& match : matches) {
    right += first.lines.at(match.first).id == second.lines.at(match.second).id ? 1 : 0;
  }
  return {right / static_cast<double>(matches.size()), right / truths};
}

template <class Associator>
std::unique_ptr<LineAssociator> make(const std::string& parameters) {
  auto associator = std::make_unique<Associator>();
  associator->configure(YAML::Load(parameters));
  return associator;
}

void expectShares(LineAssociator* associator, std::size_t step, double precision, double recall) {
  const std::vector<FrameLines>& frames = roomFrames();
  for (std::size_t i = 0; i + step < frames.size(); ++i) {
    const LineMatches matches = associator->match(frames[i], frames[i + step]);
    const Shares shares = compare(frames[i], frames[i + step], matches);
    EXPECT_GE(shares.precision, precision) << "frame " << i;
    EXPECT_GE(shares.recall, recall) << "frame " << i;
  }
}

TEST(MotionAssociators, TheOracleFindsWhatIsTrue) {
  expectShares(make<OracleAssociator>("{}").get(), 1, 0.98, 0.95);
  expectShares(make<OracleAssociator>("{}").get(), 5, 0.98, 0.9);
}

TEST(MotionAssociators, LinesOfTheNextFrameAreFoundTheBetterTheMotionIsPredicted) {
  expectShares(make<GeometricAssociator>("{prediction: none}").get(), 1, 0.55, 0.5);
  expectShares(make<GeometricAssociator>("{prediction: translation}").get(), 1, 0.95, 0.95);
  expectShares(make<GeometricAssociator>("{prediction: pose}").get(), 1, 0.98, 0.95);
}

TEST(MotionAssociators, PointsAreFollowed) {
  expectShares(make<LkTrackingAssociator>("{}").get(), 1, 0.95, 0.95);
}

TEST(MotionAssociators, ATranslationOfTheWholeImageIsPredicted) {
  const cv::Mat scene = test::texture(300, 400);
  FrameLines first;
  FrameLines second;
  first.frame.image = scene(cv::Rect(40, 40, 320, 220));
  second.frame.image = scene(cv::Rect(14, 58, 320, 220));  // all moves by (26, -18)
  first.lines = {test::segment(100, 100, 200, 100), test::segment(100, 120, 200, 120)};
  for (LineSegment line : first.lines) {
    line.x1 += 26;
    line.x2 += 26;
    line.y1 -= 18;
    line.y2 -= 18;
    second.lines.push_back(line);
  }
  for (const auto& associator :
       {make<GeometricAssociator>("{}"), make<LkTrackingAssociator>("{levels: 4}")}) {
    const LineMatches matches = associator->match(first, second);
    ASSERT_EQ(matches.size(), 2U);
    EXPECT_EQ(matches[0].second, 0U);
    EXPECT_EQ(matches[1].second, 1U);
    EXPECT_LT(matches[0].distance, 1.1F);
  }
  // Where nothing moves line 1 comes to lie near line 0's new place.
  const LineMatches still = make<GeometricAssociator>("{prediction: none}")->match(first, second);
  ASSERT_EQ(still.size(), 1U);
  EXPECT_EQ(still[0].first, 0U);
  EXPECT_EQ(still[0].second, 1U);
}

TEST(MotionAssociators, AFlatImageMovesNowhere) {
  FrameLines first;
  first.frame.image = cv::Mat(100, 120, CV_8UC1, cv::Scalar(90));
  first.lines = {test::segment(10, 10, 60, 10)};
  FrameLines second = first;
  EXPECT_EQ(make<GeometricAssociator>("{}")->match(first, second).size(), 1U);
}

TEST(MotionAssociators, AnEdgeThatHasComeBeforeAnotherIsTold) {
  FrameLines first = roomFrames()[0];
  FrameLines second = roomFrames()[0];
  second.frame.depth = cv::Mat(first.frame.depth * 0.5);  // not into the memory of both
  const std::size_t without = make<OracleAssociator>("{max_gap: 100}")->match(first, second).size();
  EXPECT_GT(without, 100U);
  // Lines that run straight away from the camera stay on themselves.
  EXPECT_LT(make<OracleAssociator>("{}")->match(first, second).size(), without / 10);
}

TEST(MotionAssociators, WhatIsMissingIsNamed) {
  const FrameLines whole = roomFrames()[0];
  FrameLines lacking = whole;
  lacking.frame.depth = cv::Mat();
  FrameLines unposed = whole;
  unposed.frame.pose.reset();
  const auto expectError = [](LineAssociator* associator, const FrameLines& first,
                              const FrameLines& second, const std::string& text) {
    try {
      associator->match(first, second);
      FAIL() << "expected: " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  const auto oracle = make<OracleAssociator>("{}");
  expectError(
      oracle.get(), lacking, whole,
      "associator oracle: the frame at " + formatStamp(whole.frame.stamp) + " s has no depth");
  expectError(oracle.get(), whole, unposed, "has no pose");
  expectError(make<GeometricAssociator>("{prediction: pose}").get(), lacking, whole,
              "associator geometric: the frame");
  FrameLines small = whole;
  small.frame.image = cv::Mat(10, 20, CV_8UC1, cv::Scalar(0));
  for (const auto& associator :
       {make<GeometricAssociator>("{}"), make<LkTrackingAssociator>("{}")}) {
    expectError(associator.get(), whole, small,
                "the images are 640x480 and 20x10, expected one size");
  }
  expectError(std::make_unique<OracleAssociator>().get(), whole, whole, "before configure()");
  EXPECT_THROW(make<LkTrackingAssociator>("{window: 20}"), ConfigError);
}

TEST(MotionAssociators, NeedsFollowTheConfiguration) {
  EXPECT_TRUE(make<OracleAssociator>("{}")->needs().pose);
  EXPECT_TRUE(make<GeometricAssociator>("{prediction: pose}")->needs().depth);
  EXPECT_FALSE(make<GeometricAssociator>("{}")->needs().depth);
  EXPECT_FALSE(make<LkTrackingAssociator>("{}")->needs().pose);
}

TEST(MotionAssociators, LinesWithoutLengthOrOutsideDoNoHarm) {
  FrameLines first = roomFrames()[0];
  FrameLines second = roomFrames()[1];
  for (FrameLines* frame : {&first, &second}) {
    frame->lines.push_back(test::segment(5, 5, 5, 5));
    frame->lines.push_back(test::segment(-50, -80, -10, -20));
    frame->lines.push_back(test::segment(630, 470, 900, 700));
  }
  for (const auto& associator : {make<GeometricAssociator>("{}"), make<LkTrackingAssociator>("{}"),
                                 make<OracleAssociator>("{}")}) {
    for (const LineMatch& match : associator->match(first, second)) {
      EXPECT_LT(match.first, first.lines.size());
      EXPECT_LT(match.second, second.lines.size());
    }
  }
}

}  // namespace
}  // namespace evolin
