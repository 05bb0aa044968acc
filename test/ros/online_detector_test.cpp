// The nodelet evolin_ros/LineDetector: what it subscribes to and when, what it sends, what it
// refuses.
#include <gtest/gtest.h>
#include <ros/param.h>
#include <sensor_msgs/Image.h>

#include <cmath>

#include "conversions.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

class OnlineDetector : public ::testing::Test {
 protected:
  OnlineDetector() : manager_(testNamespace()), publisher_(space()) {}

  const std::string& space() const { return manager_.space(); }

  ::testing::AssertionResult waitForImageListeners(unsigned count) {
    return publisher_.waitForListeners(count, 0, 0);
  }

  /// Sets a parameter of nodelet `name`, expects that it does not load, and that the log holds
  /// `parts`.
  template <class Value>
  void expectRefusal(const std::string& name, const std::string& key, const Value& value,
                     const std::vector<std::string>& parts) {
    SCOPED_TRACE(key);
    ros::param::set(space() + "/" + name + "/" + key, value);
    const LogReader log;
    EXPECT_FALSE(manager_.load(name, "evolin_ros/LineDetector"));
    EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, parts));
  }

  Manager manager_;
  SequencePublisher publisher_;
};

TEST_F(OnlineDetector, SubscribesWhileSomebodyListens) {
  ASSERT_TRUE(loadDetector(&manager_));
  // Another nodelet that does listen shows that the first would have had the time to.
  ros::param::set(space() + "/eager/lazy", false);
  ASSERT_TRUE(loadDetector(&manager_, "eager", {{"lines", "eager_lines"}}));
  ASSERT_TRUE(waitForImageListeners(1));
  ASSERT_TRUE(manager_.unload("eager"));
  ASSERT_TRUE(waitForImageListeners(0));
  {
    Collector<evolin_ros::LineArray> first(space() + "/lines");
    ASSERT_TRUE(waitForImageListeners(1));
    publisher_.sendImage(drawFrame({}, 0));
    ASSERT_TRUE(first.waitForCount(1));
  }
  ASSERT_TRUE(waitForImageListeners(0));
  Collector<evolin_ros::LineArray> second(space() + "/lines");
  ASSERT_TRUE(waitForImageListeners(1));
  publisher_.sendImage(drawFrame({}, 1));
  ASSERT_TRUE(second.waitForCount(1));
}

TEST_F(OnlineDetector, SendsTheLinesOfTheMethodUnderTheImagesHeader) {
  const std::vector<SequenceFrame> frames = drawSequence();
  ros::param::set(space() + "/detector/queue_size", 100);
  ASSERT_TRUE(loadDetector(&manager_));
  Collector<evolin_ros::LineArray> lines(space() + "/lines");
  publisher_.frame_id = "/openni_rgb_optical_frame";  // as TUM's bags name it
  ASSERT_TRUE(waitForImageListeners(1));
  for (const SequenceFrame& frame : frames) {
    publisher_.sendImage(frame);
  }
  ASSERT_TRUE(lines.waitForCount(frames.size()));

  const std::vector<LineSet> expected = detectLines(frames, kDefaultDetector);
  const std::vector<evolin_ros::LineArray> messages = lines.messages();
  std::size_t found = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE("frame " + frames[i].frame.name);
    EXPECT_EQ(ros_shell::fromRos(messages[i].header.stamp), frames[i].frame.stamp);
    EXPECT_EQ(messages[i].header.frame_id, "/openni_rgb_optical_frame");
    EXPECT_EQ(messages[i].width, 320U);
    EXPECT_EQ(messages[i].height, 240U);
    EXPECT_EQ(messages[i].source, kDefaultDetector);
    EXPECT_EQ(messages[i].has_scores, expected[i].scored);
    EXPECT_GT(messages[i].processing_time, ros::Duration(0));
    found += messages[i].lines.size();
    ASSERT_EQ(messages[i].lines.size(), expected[i].lines.size());
    for (std::size_t row = 0; row < expected[i].lines.size(); ++row) {
      const LineSegment& line = expected[i].lines[row];
      EXPECT_EQ(messages[i].lines[row].x1, line.x1);
      EXPECT_EQ(messages[i].lines[row].y2, line.y2);
      if (line.hasScore()) {
        EXPECT_EQ(messages[i].lines[row].score, line.score);
      } else {
        EXPECT_TRUE(std::isnan(messages[i].lines[row].score));
      }
      EXPECT_EQ(messages[i].lines[row].id, -1);
    }
  }
  EXPECT_GE(found, frames.size());
}

TEST_F(OnlineDetector, DrawsOnlyForThoseWhoLook) {
  const SequenceFrame frame = drawFrame({}, 3);
  ASSERT_TRUE(loadDetector(&manager_));
  {
    Collector<sensor_msgs::Image> pictures(space() + "/lines_image");
    ASSERT_TRUE(waitForImageListeners(1));
    publisher_.sendImage(frame);
    ASSERT_TRUE(pictures.waitForCount(1));
    const sensor_msgs::Image picture = pictures.messages().front();
    EXPECT_EQ(picture.width, 320U);
    EXPECT_EQ(picture.height, 240U);
    EXPECT_EQ(picture.encoding, "bgr8");
    EXPECT_EQ(ros_shell::fromRos(picture.header.stamp), frame.frame.stamp);
    const cv::Mat drawn(240, 320, CV_8UC3, const_cast<std::uint8_t*>(picture.data.data()));
    EXPECT_GT(cv::norm(drawn, frame.frame.image, cv::NORM_INF), 50) << "no line was drawn";
  }
  ASSERT_TRUE(waitForImageListeners(0));
}

TEST_F(OnlineDetector, TakesGreyImages) {
  SequenceFrame frame = drawFrame({}, 2);
  frame.frame.image = toGray(frame.frame.image);
  ASSERT_TRUE(loadDetector(&manager_));
  Collector<evolin_ros::LineArray> lines(space() + "/lines");
  ASSERT_TRUE(waitForImageListeners(1));
  publisher_.sendImage(frame);
  ASSERT_TRUE(lines.waitForCount(1));
  EXPECT_EQ(lines.messages().front().lines.size(),
            detectLines({frame}, kDefaultDetector).front().lines.size());
}

TEST_F(OnlineDetector, NamesWhatItRefuses) {
  expectRefusal("unknown", "detector", "opencv_lsdd",
                {"unknown detector 'opencv_lsdd'", "did you mean 'opencv_lsd'", "hough_p"});
  expectRefusal("misspelt", "queue_sise", 30, {"'queue_sise'", "queue_size"});
  expectRefusal("ill_typed", "queue_size", "many", {"'queue_size'", "many"});
  expectRefusal("out_of_range", "queue_size", -1, {"'queue_size'", "-1", "0"});
  expectRefusal("unavailable", "detector", "test_unavailable",
                {"detector test_unavailable", "what no build has", "available", "hough_p"});
  ros::param::set(space() + "/plugin/detector", "hough_p");
  expectRefusal("plugin", "parameters/threshold", "many", {"hough_p", "'threshold'", "many", "1"});
  expectRefusal("config", "config", "/nowhere/lsd.yaml", {"/nowhere/lsd.yaml"});
}

}  // namespace
}  // namespace evolin::test
