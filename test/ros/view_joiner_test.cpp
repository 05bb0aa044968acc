// Pairing of a picture's parts by exact stamp, with loss, lateness and jumps.
#include "view_joiner.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <string>

#include "test/support/random_lines.h"

namespace evolin::ros_shell {
namespace {

template <class Message>
boost::shared_ptr<const Message> at(std::uint32_t seconds) {
  const auto message = boost::make_shared<Message>();
  message->header.stamp = ros::Time(seconds, 5);
  return message;
}

/// A joiner with a diary: "2gm" is the picture of second 2 with ground truth and matches, "|"
/// stands before the first one of a pass.
class Diary {
 public:
  explicit Diary(std::size_t capacity = 10, std::size_t patience = 3)
      : joiner(capacity, patience) {}

  Diary& image(std::uint32_t second) {
    return note(joiner.addImage(at<sensor_msgs::Image>(second)));
  }
  Diary& lines(std::uint32_t second) {
    return note(joiner.addLines(at<evolin_ros::LineArray>(second)));
  }
  Diary& truth(std::uint32_t second) {
    return note(joiner.addGroundTruth(at<evolin_ros::LineArray>(second)));
  }
  Diary& matches(std::uint32_t second) {
    return note(joiner.addMatches(at<evolin_ros::LineMatchArray>(second)));
  }
  Diary& flush() { return note(joiner.flush()); }

  /// What came out since it was asked last.
  std::string told() { return std::exchange(told_, ""); }
  std::string problem() { return std::exchange(problem_, ""); }

  ViewJoiner joiner;

 private:
  Diary& note(const ViewJoiner::Result& result) {
    for (const ViewParts& parts : result.frames) {
      const ros::Time stamp = parts.lines->header.stamp;
      EXPECT_EQ(parts.image->header.stamp, stamp);
      EXPECT_TRUE(!parts.ground_truth || parts.ground_truth->header.stamp == stamp);
      EXPECT_TRUE(!parts.matches || parts.matches->header.stamp == stamp);
      told_ += std::string(told_.empty() ? "" : " ") + (parts.begins_pass ? "|" : "") +
               std::to_string(stamp.sec) + (parts.ground_truth ? "g" : "") +
               (parts.matches ? "m" : "");
    }
    problem_ = result.problem.empty() ? problem_ : result.problem;
    return *this;
  }

  std::string told_;
  std::string problem_;
};

TEST(ViewJoiner, PairsWhicheverComesFirst) {
  Diary diary;
  EXPECT_EQ(diary.image(1).told(), "");
  EXPECT_EQ(diary.lines(1).told(), "1");
  EXPECT_EQ(diary.truth(2).image(2).told(), "");
  EXPECT_EQ(diary.lines(2).told(), "2g");
  EXPECT_EQ(diary.lines(3).image(3).told(), "") << "ground truth is alive and awaited";
  EXPECT_EQ(diary.truth(3).told(), "3g");
  EXPECT_EQ(diary.matches(4).truth(4).lines(4).told(), "");
  EXPECT_EQ(diary.image(4).told(), "4gm");
  EXPECT_EQ(diary.joiner.unpaired().sum(), 0U);
  EXPECT_EQ(diary.problem(), "");
}

TEST(ViewJoiner, WaitsForLivingStreamsWithPatience) {
  Diary diary(20, 3);
  EXPECT_EQ(diary.truth(1).matches(1).lines(1).image(1).told(), "1gm");
  EXPECT_EQ(diary.truth(2).lines(2).image(2).told(), "");
  EXPECT_EQ(diary.truth(3).lines(3).image(3).truth(4).lines(4).image(4).told(), "");
  EXPECT_EQ(diary.matches(3).told(), "") << "order is kept";
  EXPECT_EQ(diary.truth(5).lines(5).image(5).told(), "2g 3gm");
  EXPECT_EQ(diary.matches(5).told(), "");
  EXPECT_EQ(diary.flush().told(), "4g 5gm");
  EXPECT_EQ(diary.joiner.unpaired().sum(), 0U);
  // The matches of a picture that is out already.
  diary.matches(2);
  EXPECT_EQ(diary.lines(6).image(6).truth(6).matches(6).told(), "6gm");
  EXPECT_EQ(diary.joiner.unpaired().matches, 1U);
}

TEST(ViewJoiner, ASilentStreamIsNotWaitedFor) {
  Diary diary(50, 3);
  EXPECT_EQ(diary.truth(1).lines(1).image(1).told(), "1g");
  std::string told;
  for (std::uint32_t second = 2; second < 30; ++second) {
    told = diary.lines(second).image(second).told();
  }
  EXPECT_EQ(told, "29");
}

TEST(ViewJoiner, AnExpectedStreamIsWaitedForFromTheFirstFrame) {
  Diary diary;
  diary.joiner.expectGroundTruth();
  EXPECT_EQ(diary.lines(1).image(1).told(), "");
  EXPECT_EQ(diary.truth(1).told(), "1g");
  diary.joiner.expectMatches();
  EXPECT_EQ(diary.lines(2).image(2).truth(2).told(), "");
  EXPECT_EQ(diary.matches(2).told(), "2gm");
}

TEST(ViewJoiner, LinesWithoutImageAreCountedAndNamed) {
  Diary diary;
  diary.lines(1).lines(2).lines(3);
  EXPECT_EQ(diary.image(3).told(), "3");
  EXPECT_EQ(diary.joiner.unpaired().lines, 2U);
  EXPECT_NE(diary.problem().find("lines at 2.000000005 have no image"), std::string::npos)
      << diary.problem();
  // An image that is merely near: its offset is named once the buffer is full.
  Diary narrow(2, 1);
  narrow.image(8).lines(10).lines(11).lines(12);
  EXPECT_EQ(narrow.joiner.unpaired().lines, 1U);
  EXPECT_NE(narrow.problem().find("the nearest image is -2.0"), std::string::npos)
      << narrow.problem();
}

TEST(ViewJoiner, PartsWithoutLinesAreCounted) {
  Diary diary;
  diary.image(1).truth(1).matches(1).image(2).truth(2);
  EXPECT_EQ(diary.lines(2).told(), "");
  EXPECT_EQ(diary.matches(2).told(), "2gm");
  EXPECT_EQ(diary.joiner.unpaired().images, 1U);
  EXPECT_EQ(diary.joiner.unpaired().ground_truths, 1U);
  EXPECT_EQ(diary.joiner.unpaired().matches, 1U);
  EXPECT_EQ(diary.joiner.unpaired().lines, 0U);
}

TEST(ViewJoiner, MemoryIsBounded) {
  Diary diary(5, 3);
  for (std::uint32_t second = 1; second <= 100; ++second) {
    diary.image(second).truth(second).matches(second);
  }
  EXPECT_EQ(diary.joiner.unpaired().images, 95U);
  EXPECT_EQ(diary.joiner.unpaired().ground_truths, 95U);
  EXPECT_EQ(diary.joiner.unpaired().matches, 95U);
  for (std::uint32_t second = 201; second <= 300; ++second) {
    diary.lines(second);
  }
  EXPECT_EQ(diary.joiner.unpaired().lines, 95U);
}

TEST(ViewJoiner, RepeatsAreLeftOut) {
  Diary diary;
  EXPECT_EQ(diary.image(1).lines(1).lines(1).told(), "1");
  EXPECT_NE(diary.problem().find("came twice"), std::string::npos);
  EXPECT_EQ(diary.joiner.unpaired().lines, 1U);
}

TEST(ViewJoiner, AJumpBackBeginsAPass) {
  Diary diary(10, 3);
  EXPECT_EQ(diary.image(5).lines(5).image(6).lines(6).told(), "5 6");
  // Images of the next pass may come before the last lines of this one.
  EXPECT_EQ(diary.image(7).image(1).lines(7).told(), "7");
  EXPECT_EQ(diary.lines(1).told(), "|1");
  EXPECT_EQ(diary.image(2).lines(2).told(), "2");
  EXPECT_EQ(diary.joiner.unpaired().sum(), 0U);
}

TEST(ViewJoiner, WhatWaitsAtAJumpIsShownBeforeIt) {
  Diary diary(10, 3);
  EXPECT_EQ(diary.truth(5).image(5).lines(5).told(), "5g");
  EXPECT_EQ(diary.image(6).lines(6).lines(7).told(), "");
  EXPECT_EQ(diary.lines(1).told(), "6");
  EXPECT_EQ(diary.truth(1).image(1).told(), "|1g");
  EXPECT_EQ(diary.joiner.unpaired().lines, 1U);
}

TEST(ViewJoiner, GivesEveryFrameWholeAndInOrderWhateverTheLag) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    test::RandomLines random(seed);
    Diary diary(20, 8);
    constexpr std::uint32_t kLast = 60;
    // Of streams that nobody has heard the joiner cannot know.
    diary.truth(1).matches(1);
    std::uint32_t next[4] = {1, 1, 2, 2};
    const auto slowest = [&] { return *std::min_element(next, next + 4); };
    while (slowest() <= kLast) {
      const std::size_t kind = random.index(4);
      // No stream is more than eight ahead of another.
      if (next[kind] > kLast || next[kind] > slowest() + 6) {
        continue;
      }
      const std::uint32_t second = next[kind]++;
      kind == 0   ? diary.image(second)
      : kind == 1 ? diary.lines(second)
      : kind == 2 ? diary.truth(second)
                  : diary.matches(second);
    }
    const std::string told = diary.flush().told();
    EXPECT_EQ(diary.joiner.unpaired().sum(), 0U) << "seed " << seed << ": " << told;
    EXPECT_EQ(std::count(told.begin(), told.end(), 'g'), kLast);
    EXPECT_EQ(std::count(told.begin(), told.end(), 'm'), kLast);
  }
}

}  // namespace
}  // namespace evolin::ros_shell
