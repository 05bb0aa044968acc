// Pairing of images and lines by exact stamp, with loss, lateness and jumps.
#include "frame_lines_joiner.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <string>

#include "test/support/random_lines.h"

namespace evolin::ros_shell {
namespace {

using Result = FrameLinesJoiner::Result;

sensor_msgs::ImageConstPtr image(std::uint32_t seconds) {
  const auto message = boost::make_shared<sensor_msgs::Image>();
  message->header.stamp = ros::Time(seconds, 5);
  return message;
}

evolin_ros::LineArrayConstPtr lines(std::uint32_t seconds) {
  const auto message = boost::make_shared<evolin_ros::LineArray>();
  message->header.stamp = ros::Time(seconds, 5);
  return message;
}

/// Seconds of the complete frames; checks that both parts have the same stamp.
std::vector<std::uint32_t> completeIn(const Result& result) {
  std::vector<std::uint32_t> stamps;
  for (const FrameLinesJoiner::Pair& pair : result.complete) {
    EXPECT_EQ(pair.image->header.stamp, pair.lines->header.stamp);
    stamps.push_back(pair.lines->header.stamp.sec);
  }
  return stamps;
}

using Stamps = std::vector<std::uint32_t>;

Stamps leftOutIn(const Result& result) {
  Stamps stamps;
  for (const std_msgs::Header& header : result.left_out) {
    stamps.push_back(header.stamp.sec);
  }
  return stamps;
}

TEST(FrameLinesJoiner, PairsWhicheverComesFirst) {
  FrameLinesJoiner joiner(10);
  EXPECT_EQ(completeIn(joiner.addImage(image(1))), Stamps());
  EXPECT_EQ(completeIn(joiner.addLines(lines(1))), Stamps({1}));
  EXPECT_EQ(completeIn(joiner.addLines(lines(2))), Stamps());
  EXPECT_EQ(completeIn(joiner.addLines(lines(3))), Stamps());
  EXPECT_EQ(completeIn(joiner.addImage(image(2))), Stamps({2}));
  EXPECT_EQ(completeIn(joiner.addImage(image(3))), Stamps({3}));
}

TEST(FrameLinesJoiner, GivesEveryFrameOnceAndInOrderWhateverTheLag) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::RandomLines random(seed);
    FrameLinesJoiner joiner(10);
    Stamps complete;
    std::uint32_t next_image = 1;
    std::uint32_t next_lines = 1;
    constexpr std::uint32_t kLast = 100;
    while (next_image <= kLast || next_lines <= kLast) {
      const bool image_first =
          next_lines > kLast || next_lines >= next_image + 9 ||
          (next_image <= kLast && next_image < next_lines + 9 && random.index(2) == 0);
      const Result result =
          image_first ? joiner.addImage(image(next_image++)) : joiner.addLines(lines(next_lines++));
      EXPECT_TRUE(result.problem.empty()) << result.problem;
      for (const auto& pair : result.complete) EXPECT_FALSE(pair.begins_pass);
      const Stamps now = completeIn(result);
      complete.insert(complete.end(), now.begin(), now.end());
    }
    ASSERT_EQ(complete.size(), kLast);
    for (std::uint32_t i = 0; i < kLast; ++i) EXPECT_EQ(complete[i], i + 1);
  }
}

TEST(FrameLinesJoiner, ARepeatedLineArrayCountsOnce) {
  FrameLinesJoiner joiner(10);
  joiner.addImage(image(1));
  EXPECT_EQ(completeIn(joiner.addLines(lines(1))), Stamps({1}));
  joiner.addImage(image(1));
  const Result again = joiner.addLines(lines(1));
  EXPECT_TRUE(again.complete.empty());
}

TEST(FrameLinesJoiner, LinesWithoutAnImageHoldNobodyUp) {
  FrameLinesJoiner joiner(10);
  EXPECT_EQ(leftOutIn(joiner.addLines(lines(1))), Stamps());
  joiner.addLines(lines(2));
  joiner.addLines(lines(3));
  const Result result = joiner.addImage(image(3));
  EXPECT_EQ(completeIn(result), Stamps({3}));
  EXPECT_EQ(leftOutIn(result), Stamps({1, 2}));
  EXPECT_NE(result.problem.find("lines at 1.000000005"), std::string::npos) << result.problem;
  EXPECT_NE(result.problem.find("~queue_size"), std::string::npos);
  EXPECT_TRUE(joiner.addImage(image(1)).complete.empty()) << "an earlier frame after a later one";
}

TEST(FrameLinesJoiner, ImagesWithoutLinesArePassedOver) {
  FrameLinesJoiner joiner(3);
  for (std::uint32_t second = 1; second <= 50; ++second) joiner.addImage(image(second));
  EXPECT_TRUE(joiner.addLines(lines(47)).complete.empty()) << "only three images are kept";
  EXPECT_EQ(completeIn(joiner.addLines(lines(48))), Stamps({48}));
  EXPECT_EQ(completeIn(joiner.addLines(lines(50))), Stamps({50}));
}

TEST(FrameLinesJoiner, SaysHowFarTheNearestImageIs) {
  FrameLinesJoiner joiner(2);
  joiner.addImage(image(5));
  joiner.addImage(image(14));
  joiner.addLines(lines(10));
  joiner.addLines(lines(11));
  const Result result = joiner.addLines(lines(12));
  EXPECT_NE(result.problem.find("lines at 10.000000005"), std::string::npos) << result.problem;
  EXPECT_EQ(leftOutIn(result), Stamps({10}));
  EXPECT_NE(result.problem.find("nearest image is 4.0"), std::string::npos) << result.problem;

  FrameLinesJoiner without_images(1);
  without_images.addLines(lines(1));
  EXPECT_NE(without_images.addLines(lines(2)).problem.find("no image is waiting"),
            std::string::npos);
}

TEST(FrameLinesJoiner, TellsOfAJumpBackWithTheFirstFrameAfterIt) {
  FrameLinesJoiner joiner(10);
  for (const std::uint32_t second : {1U, 2U, 3U}) {
    joiner.addImage(image(second));
    const Result result = joiner.addLines(lines(second));
    ASSERT_EQ(completeIn(result), Stamps({second}));
    EXPECT_FALSE(result.complete.front().begins_pass);
  }
  joiner.addLines(lines(4));  // its image was lost at the end of the pass
  joiner.addImage(image(1));
  const Result result = joiner.addLines(lines(1));
  ASSERT_EQ(completeIn(result), Stamps({1}));
  EXPECT_TRUE(result.complete.front().begins_pass);
  EXPECT_NE(result.problem.find("lines at 4.000000005"), std::string::npos) << result.problem;
  joiner.addImage(image(2));
  const Result after = joiner.addLines(lines(2));
  ASSERT_EQ(completeIn(after), Stamps({2}));
  EXPECT_FALSE(after.complete.front().begins_pass);
}

/// Which of the streams is behind, and by how much, is a matter of sockets and threads.
TEST(FrameLinesJoiner, NothingIsLostWhereOneStreamJumpsBeforeTheOther) {
  const Stamps twice = {1, 2, 3, 4, 5, 1, 2, 3, 4, 5};
  for (std::size_t lag = 0; lag < 5; ++lag) {
    for (const bool images_lag : {true, false}) {
      SCOPED_TRACE((images_lag ? "images behind by " : "lines behind by ") + std::to_string(lag));
      FrameLinesJoiner joiner(10);
      Stamps complete;
      Stamps beginnings;  // of passes, by place
      const auto take = [&](const Result& result) {
        EXPECT_TRUE(result.problem.empty()) << result.problem;
        for (const FrameLinesJoiner::Pair& pair : result.complete) {
          if (pair.begins_pass) beginnings.push_back(static_cast<std::uint32_t>(complete.size()));
          complete.push_back(pair.lines->header.stamp.sec);
          EXPECT_EQ(pair.image->header.stamp, pair.lines->header.stamp);
        }
      };
      for (std::size_t i = 0; i < twice.size() + lag; ++i) {
        for (const bool behind : {false, true}) {
          const std::size_t place = behind ? i - lag : i;
          if (place >= twice.size()) continue;  // wraps around below 0, too
          take(behind == images_lag ? joiner.addImage(image(twice[place]))
                                    : joiner.addLines(lines(twice[place])));
        }
      }
      EXPECT_EQ(complete, twice);
      EXPECT_EQ(beginnings, Stamps({5}));
    }
  }
}

}  // namespace
}  // namespace evolin::ros_shell
