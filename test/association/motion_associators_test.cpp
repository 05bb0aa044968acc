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
#include "test/association/halved_frame.h"
#include "test/association/textured_images.h"
#include "test/support/expect_error.h"

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

/// Of every pair of frames `step` apart; the means over them are recorded under `name`.
void expectShares(LineAssociator* associator, const std::string& name, std::size_t step,
                  double precision, double recall) {
  const std::vector<FrameLines>& frames = roomFrames();
  Shares mean;
  const std::size_t pairs = frames.size() - step;
  for (std::size_t i = 0; i < pairs; ++i) {
    const LineMatches matches = associator->match(frames[i], frames[i + step]);
    const Shares shares = compare(frames[i], frames[i + step], matches);
    EXPECT_GE(shares.precision, precision) << "frame " << i;
    EXPECT_GE(shares.recall, recall) << "frame " << i;
    mean.precision += shares.precision / static_cast<double>(pairs);
    mean.recall += shares.recall / static_cast<double>(pairs);
  }
  ::testing::Test::RecordProperty(name + "_precision", std::to_string(mean.precision));
  ::testing::Test::RecordProperty(name + "_recall", std::to_string(mean.recall));
}

TEST(MotionAssociators, TheOracleFindsWhatIsTrue) {
  expectShares(make<OracleAssociator>("{}").get(), "oracle", 1, 0.98, 0.95);
  expectShares(make<OracleAssociator>("{}").get(), "oracle_5", 5, 0.98, 0.9);
}

TEST(MotionAssociators, LinesOfTheNextFrameAreFoundTheBetterTheMotionIsPredicted) {
  expectShares(make<GeometricAssociator>("{prediction: none}").get(), "none", 1, 0.55, 0.5);
  expectShares(make<GeometricAssociator>("{prediction: translation}").get(), "translation", 1, 0.95,
               0.95);
  expectShares(make<GeometricAssociator>("{prediction: pose}").get(), "pose", 1, 0.98, 0.95);
}

TEST(MotionAssociators, PointsAreFollowed) {
  expectShares(make<LkTrackingAssociator>("{}").get(), "lk_tracking", 1, 0.95, 0.95);
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

TEST(MotionAssociators, AnImageOfOneColumnOrRowMovesNowhere) {
  for (const cv::Size& size : {cv::Size(1, 480), cv::Size(2, 480), cv::Size(640, 1),
                               cv::Size(640, 2), cv::Size(1, 1), cv::Size(3, 3)}) {
    FrameLines first;
    first.frame.image = test::texture(size.height, size.width);
    first.lines = {test::segment(0, 0, size.width - 1, size.height)};
    FrameLines second = first;
    EXPECT_EQ(make<GeometricAssociator>("{}")->match(first, second).size(), 1U) << size;
  }
}

TEST(MotionAssociators, AWindowIntoALargerImageIsFollowedAsItsCopy) {
  const cv::Mat scene = test::texture(300, 400);
  cv::Mat first_whole = test::texture(300, 400, 8);
  cv::Mat second_whole = test::texture(300, 400, 9);
  const cv::Rect window(90, 80, 200, 140);
  scene(window).copyTo(first_whole(window));
  scene(window + cv::Point(3, 2)).copyTo(second_whole(window));
  FrameLines first;
  FrameLines second;
  first.frame.image = first_whole(window);
  second.frame.image = second_whole(window);
  for (const double inwards : {2.0, 5.0, 9.0, 60.0}) {
    first.lines.push_back(test::segment(10 + inwards, inwards, 180, inwards));
    first.lines.push_back(test::segment(inwards, 10 + inwards, inwards, 130));
  }
  second.lines = first.lines;
  FrameLines first_copy = first;
  FrameLines second_copy = second;
  first_copy.frame.image = first.frame.image.clone();
  second_copy.frame.image = second.frame.image.clone();
  const auto associator = make<LkTrackingAssociator>("{}");
  const LineMatches matches = associator->match(first, second);
  const LineMatches copied = associator->match(first_copy, second_copy);
  ASSERT_GE(matches.size(), 4U);
  ASSERT_EQ(matches.size(), copied.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_EQ(matches[i].first, copied[i].first);
    EXPECT_EQ(matches[i].second, copied[i].second);
    EXPECT_EQ(matches[i].distance, copied[i].distance) << i;
  }
}
TEST(MotionAssociators, EachFrameIsSeenByItsOwnCamera) {
  const FrameLines& first = roomFrames()[0];
  const FrameLines second = test::halved(roomFrames()[1]);
  for (const auto& associator :
       {make<OracleAssociator>("{}"), make<GeometricAssociator>("{prediction: pose}")}) {
    const Shares forwards = compare(first, second, associator->match(first, second));
    EXPECT_GE(forwards.precision, 0.9);
    EXPECT_GE(forwards.recall, 0.9);
    const Shares backwards = compare(second, first, associator->match(second, first));
    EXPECT_GE(backwards.precision, 0.9);
    EXPECT_GE(backwards.recall, 0.9);
    FrameLines unknown = second;
    unknown.frame.camera.reset();
    test::expectError([&] { associator->match(first, unknown); },
                      {"the frame at " + formatStamp(unknown.frame.stamp) + " s has no camera"});
  }
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
    test::expectError([&] { associator->match(first, second); }, {text});
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
