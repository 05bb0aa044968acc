// What a picture shows of a frame: verdicts, reasons for their absence, trails by matches and ids.
#include "view_frame.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <limits>

#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

constexpr int kSide = 128;  // a pixel of the image is one of the scaled image

evolin_ros::Line line(double x1, double y1, double x2, double y2, std::int64_t id = kNoId) {
  evolin_ros::Line result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  result.score = kNoScore;
  result.id = id;
  return result;
}

boost::shared_ptr<evolin_ros::LineArray> lines(const std::string& source,
                                               const std::vector<evolin_ros::Line>& rows,
                                               std::uint32_t second = 1) {
  auto message = boost::make_shared<evolin_ros::LineArray>();
  message->header.stamp = ros::Time(second, 0);
  message->source = source;
  message->width = message->height = kSide;
  message->lines = rows;
  return message;
}

boost::shared_ptr<evolin_ros::LineMatchArray> matches(
    const std::string& lines_source, std::uint32_t first_second, std::uint32_t second,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  auto message = boost::make_shared<evolin_ros::LineMatchArray>();
  message->first_stamp = ros::Time(first_second, 0);
  message->header.stamp = ros::Time(second, 0);
  message->lines_source = lines_source;
  for (const auto& [first, other] : pairs) {
    message->matches.emplace_back();
    message->matches.back().first = first;
    message->matches.back().second = other;
  }
  return message;
}

sensor_msgs::ImageConstPtr image() {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->width = message->height = message->step = kSide;
  message->encoding = "mono8";
  message->data.assign(kSide * kSide, 90);
  return message;
}

ViewParts parts(const evolin_ros::LineArrayConstPtr& detected,
                const evolin_ros::LineArrayConstPtr& truth = nullptr,
                const evolin_ros::LineMatchArrayConstPtr& matched = nullptr) {
  ViewParts result;
  result.image = image();
  result.lines = detected;
  result.ground_truth = truth;
  result.matches = matched;
  return result;
}

TEST(ViewFrames, JudgeLinesAtTheThreshold) {
  const auto detected = lines("lsd", {line(10, 10, 40, 20), line(10, 60, 40, 67)});
  const auto truth = lines("ground_truth", {line(40, 21, 10, 11), line(10, 64, 40, 71)});
  for (const double threshold : {5.0, 10.0}) {
    ViewFrameOptions options;
    options.threshold = threshold;
    ViewFrames frames(options);
    const EvaluatedFrame frame = frames.make(parts(detected, truth));
    EXPECT_EQ(frame.no_verdicts, "");
    EXPECT_EQ(frame.verdicts.count(LineVerdict::kTruePositive), threshold == 5 ? 1U : 2U);
    EXPECT_EQ(frame.verdicts.misses(), threshold == 5 ? 1U : 0U);
    EXPECT_EQ(frame.ground_truth.size(), 2U);
    EXPECT_EQ(frame.title, "lsd  1.000000");
    EXPECT_EQ(frame.judged_by,
              threshold == 5 ? "structural distance < 5" : "structural distance < 10");
    EXPECT_EQ(frame.image.cols, kSide);
  }
}

TEST(ViewFrames, SayWhyLinesAreNotJudged) {
  ViewFrames frames({});
  const auto detected = lines("lsd", {line(10, 10, 40, 20)});
  EXPECT_EQ(frames.make(parts(detected)).no_verdicts, "no ground truth of this image");
  EXPECT_TRUE(frames.problems().empty());

  const auto outside = lines("ground_truth", {line(10, 10, 400, 20)});
  EXPECT_NE(frames.make(parts(detected, outside)).no_verdicts.find("leaves the image"),
            std::string::npos);
  EXPECT_EQ(frames.problems().size(), 1U);

  const auto other_size = lines("ground_truth", {line(10, 10, 40, 20)});
  other_size->width = 640;
  const EvaluatedFrame frame = frames.make(parts(detected, other_size));
  EXPECT_NE(frame.no_verdicts.find("'ground_truth' are of an image of 640 x 128"),
            std::string::npos)
      << frame.no_verdicts;
  EXPECT_EQ(frame.lines.size(), 1U);
  EXPECT_TRUE(frame.ground_truth.empty());

  const auto broken = lines("lsd", {line(10, 10, std::numeric_limits<double>::quiet_NaN(), 20)});
  EXPECT_NE(frames.make(parts(broken, lines("ground_truth", {}))).no_verdicts.find("not finite"),
            std::string::npos);
  EXPECT_NO_THROW(drawEvaluatedFrame(frames.make(parts(broken)), {}));
}

TEST(ViewFrames, FollowMatchesOfTheLinesThatTheyNameOnly) {
  ViewFrames frames({});
  const auto make = [&](const std::string& lines_source) {
    frames.clear();
    frames.make(parts(lines("lsd", {line(10, 10, 20, 10)}, 1),
                      lines("ground_truth", {line(50, 50, 60, 50)}, 1)));
    return frames.make(parts(lines("lsd", {line(10, 20, 20, 20)}, 2),
                             lines("ground_truth", {line(50, 60, 60, 60)}, 2),
                             matches(lines_source, 1, 2, {{0, 0}})));
  };
  EXPECT_EQ(make("lsd").trails.at(0).points, (std::vector<cv::Point2d>{{15, 10}, {15, 20}}));
  EXPECT_EQ(make("ground_truth").trails.at(0).points,
            (std::vector<cv::Point2d>{{55, 50}, {55, 60}}));
  EXPECT_TRUE(frames.problems().empty());
  EXPECT_TRUE(make("edlines").trails.empty());
  ASSERT_EQ(frames.problems().size(), 1U);
  EXPECT_NE(frames.problems()[0].find("'edlines'"), std::string::npos);
}

TEST(ViewFrames, FollowIds) {
  ViewFrameOptions options;
  options.trails_from = TrailsFrom::kIds;
  ViewFrames frames(options);
  frames.make(parts(lines("tracker", {line(10, 10, 20, 10, 5)}, 1)));
  const EvaluatedFrame frame =
      frames.make(parts(lines("tracker", {line(1, 1, 2, 2), line(10, 20, 20, 20, 5)}, 2)));
  ASSERT_EQ(frame.trails.size(), 1U);
  EXPECT_EQ(frame.trails[0].track, 5);
  frames.make(parts(lines("tracker", {line(1, 1, 2, 2, 5), line(1, 1, 3, 3, 5)}, 3)));
  ASSERT_EQ(frames.problems().size(), 1U);
  EXPECT_NE(frames.problems()[0].find("no trails"), std::string::npos);
}

TEST(ViewFrames, APassForgetsTheOneBefore) {
  ViewFrames frames({});
  frames.make(parts(lines("lsd", {line(10, 10, 20, 10)}, 1)));
  ViewParts next =
      parts(lines("lsd", {line(10, 20, 20, 20)}, 2), nullptr, matches("lsd", 1, 2, {{0, 0}}));
  next.begins_pass = true;
  EXPECT_TRUE(frames.make(next).trails.empty());
}

TEST(ViewFrames, RefuseImagesThatCannotBeShown) {
  ViewParts broken = parts(lines("lsd", {}));
  auto message = boost::make_shared<sensor_msgs::Image>(*broken.image);
  message->encoding = "bayer_of_mars";
  broken.image = message;
  ViewFrames frames({});
  test::expectError([&] { frames.make(broken); }, {"bayer_of_mars"});
}

}  // namespace
}  // namespace evolin::ros_shell
