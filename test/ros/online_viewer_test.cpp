// The nodelet evolin_ros/LineViewer: when it works, what its pictures and markers show, and what it
// names.
#include <gtest/gtest.h>
#include <ros/param.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "evolin_ros/DetectionMetrics.h"
#include "evolin_ros/drawing/evaluation_view.h"
#include "evolin_ros/drawing/palette.h"
#include "online_stream.h"

namespace evolin::test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
// Rows of the lines below; all run from x = 40 to x = 280.
constexpr double kTrueRow = 60;
constexpr double kFalseRow = 120;
constexpr double kMissedRow = 180;

/// Slightly inclined: the protocol drops level detections.
evolin_ros::Line line(double row) {
  evolin_ros::Line result;
  result.x1 = 40;
  result.y1 = row - 0.3;
  result.x2 = 280;
  result.y2 = row + 0.3;
  result.score = kNoScore;
  result.id = kNoId;
  return result;
}

/// The inputs of a viewer in a namespace.
class Feed {
 public:
  explicit Feed(const std::string& space) {
    ros::NodeHandle handle(space);
    image_ = handle.advertise<sensor_msgs::Image>("image", 100);
    camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 100);
    lines_ = handle.advertise<evolin_ros::LineArray>("lines", 100);
    ground_truth_ = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", 100);
    matches_ = handle.advertise<evolin_ros::LineMatchArray>("matches", 100);
    detection_ =
        handle.advertise<evolin_ros::DetectionMetrics>("metrics/detection/cumulative", 100);
  }

  ::testing::AssertionResult waitForListeners(unsigned count) {
    return waitFor(std::to_string(count) + " listeners to every input", [&] {
      for (const ros::Publisher* publisher :
           {&image_, &camera_info_, &lines_, &ground_truth_, &matches_, &detection_}) {
        if (publisher->getNumSubscribers() != count) {
          return false;
        }
      }
      return true;
    });
  }

  void sendImage(double second) {
    sensor_msgs::Image message;
    message.header = header(second);
    message.width = kWidth;
    message.height = kHeight;
    message.step = kWidth;
    message.encoding = "mono8";
    message.data.assign(kWidth * kHeight, 100);
    image_.publish(message);
  }

  void sendCamera(double second) {
    sensor_msgs::CameraInfo message;
    message.header = header(second);
    message.width = kWidth;
    message.height = kHeight;
    message.K = {200, 0, 160, 0, 200, 120, 0, 0, 1};
    camera_info_.publish(message);
  }

  void sendLines(double second) {
    lines_.publish(array(second, "front_end", {line(kTrueRow), line(kFalseRow)}));
  }

  void sendGroundTruth(double second) {
    ground_truth_.publish(array(second, "ground_truth", {line(kTrueRow), line(kMissedRow)}));
  }

  void sendMatches(double first, double second) {
    evolin_ros::LineMatchArray message;
    message.header = header(second);
    message.first_stamp = ros::Time(first);
    message.lines_source = "front_end";
    message.matches.resize(1);
    message.matches[0].first = 0;
    message.matches[0].second = 0;
    matches_.publish(message);
  }

  void sendFigures(std::uint32_t frames) {
    evolin_ros::DetectionMetrics message;
    message.frames = frames;
    detection_.publish(message);
  }

  /// All parts of a frame.
  void send(double second) {
    sendCamera(second);
    sendGroundTruth(second);
    sendLines(second);
    sendImage(second);
  }

  static std_msgs::Header header(double second) {
    std_msgs::Header result;
    result.stamp = ros::Time(second);
    result.frame_id = "/camera_optical";
    return result;
  }

 private:
  static evolin_ros::LineArray array(double second, const std::string& source,
                                     const std::vector<evolin_ros::Line>& lines) {
    evolin_ros::LineArray message;
    message.header = header(second);
    message.source = source;
    message.width = kWidth;
    message.height = kHeight;
    message.lines = lines;
    return message;
  }

  ros::Publisher image_;
  ros::Publisher camera_info_;
  ros::Publisher lines_;
  ros::Publisher ground_truth_;
  ros::Publisher matches_;
  ros::Publisher detection_;
};

class OnlineViewer : public ::testing::Test {
 protected:
  OnlineViewer() : manager_(testNamespace()), feed_(space()) {}

  const std::string& space() const { return manager_.space(); }

  bool load(const std::string& name = "viewer",
            const std::map<std::string, std::string>& remappings = {}) {
    return manager_.load(name, "evolin_ros/LineViewer", remappings);
  }

  template <class Value>
  void set(const std::string& key, const Value& value) {
    ros::param::set(space() + "/viewer/" + key, value);
  }

  Manager manager_;
  Feed feed_;
};

/// Whether a pixel of the colour is among those around image point (x, y).
::testing::AssertionResult shows(const sensor_msgs::Image& picture, const Colour& colour, double x,
                                 double y, double scale = 1) {
  const cv::Mat pixels(static_cast<int>(picture.height), static_cast<int>(picture.width), CV_8UC3,
                       const_cast<std::uint8_t*>(picture.data.data()), picture.step);
  int nearest = 1000;
  const int reach = 3 * static_cast<int>(scale);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const auto& pixel = pixels.at<cv::Vec3b>(cvRound(y * scale) + dy, cvRound(x * scale) + dx);
      nearest = std::min(
          nearest, std::max({std::abs(pixel[0] - colour.blue), std::abs(pixel[1] - colour.green),
                             std::abs(pixel[2] - colour.red)}));
    }
  }
  return nearest < 50 ? ::testing::AssertionSuccess()
                      : ::testing::AssertionFailure() << "the nearest colour around (" << x << ", "
                                                      << y << ") is " << nearest << " away";
}

/// Of the markers, by namespace; DELETEALL stands under "".
std::map<std::string, Marker> byName(const MarkerArray& array) {
  std::map<std::string, Marker> markers;
  for (const Marker& marker : array.markers) {
    EXPECT_TRUE(markers.emplace(marker.ns, marker).second) << marker.ns << " occurs twice";
  }
  return markers;
}

bool deletesAll(const MarkerArray& array) {
  return !array.markers.empty() && array.markers.front().action == Marker::DELETEALL;
}

TEST_F(OnlineViewer, ListensOnlyWhileSomebodyLooks) {
  ASSERT_TRUE(load());
  // Another viewer that is looked at shows that the first would have had the time to listen.
  ASSERT_TRUE(load("other", {{"overlay", "other_overlay"}, {"markers", "other_markers"}}));
  {
    Collector<MarkerArray> other(space() + "/other_markers");
    ASSERT_TRUE(feed_.waitForListeners(1));
    ASSERT_TRUE(manager_.unload("other"));
    ASSERT_TRUE(feed_.waitForListeners(0));
  }
  for (int round = 0; round < 2; ++round) {
    {
      Collector<sensor_msgs::Image> pictures(space() + "/overlay");
      ASSERT_TRUE(feed_.waitForListeners(1));
      feed_.send(10 - round);
      ASSERT_TRUE(pictures.waitForCount(1));
    }
    ASSERT_TRUE(feed_.waitForListeners(0));
  }
}

TEST_F(OnlineViewer, DrawsVerdictsUnderTheImagesHeader) {
  ASSERT_TRUE(load());
  Collector<sensor_msgs::Image> pictures(space() + "/overlay");
  ASSERT_TRUE(feed_.waitForListeners(1));
  feed_.send(5);
  ASSERT_TRUE(pictures.waitForCount(1));
  const sensor_msgs::Image picture = pictures.messages().front();
  EXPECT_EQ(picture.header.stamp, ros::Time(5));
  EXPECT_EQ(picture.header.frame_id, "/camera_optical");
  EXPECT_EQ(picture.encoding, "bgr8");
  EXPECT_EQ(picture.width, static_cast<unsigned>(kWidth + kViewMargin));
  EXPECT_GT(picture.height, static_cast<unsigned>(kHeight)) << "the margin's text needs more";
  EXPECT_TRUE(shows(picture, palette::kTruePositive, 160, kTrueRow));
  EXPECT_TRUE(shows(picture, palette::kFalsePositive, 160, kFalseRow));
  EXPECT_TRUE(shows(picture, palette::kMissed, 160, kMissedRow));
  EXPECT_FALSE(shows(picture, palette::kTruePositive, 160, 90));
  EXPECT_TRUE(shows(picture, {60, 60, 60}, 160, 90)) << "the image, darkened";
}

TEST_F(OnlineViewer, ScalesForDisplaysOfHighDensity) {
  set("scale", 2.0);
  set("margin", false);
  ASSERT_TRUE(load());
  Collector<sensor_msgs::Image> pictures(space() + "/overlay");
  ASSERT_TRUE(feed_.waitForListeners(1));
  feed_.send(5);
  ASSERT_TRUE(pictures.waitForCount(1));
  const sensor_msgs::Image picture = pictures.messages().front();
  EXPECT_EQ(picture.width, 2U * kWidth);
  EXPECT_EQ(picture.height, 2U * kHeight);
  EXPECT_TRUE(shows(picture, palette::kTruePositive, 160, kTrueRow, 2));
  EXPECT_TRUE(shows(picture, palette::kFalsePositive, 160, kFalseRow, 2));
  EXPECT_TRUE(shows(picture, palette::kMissed, 160, kMissedRow, 2));
}

TEST_F(OnlineViewer, ALineWithoutGroundTruthIsShownAllTheSame) {
  ASSERT_TRUE(load());
  Collector<sensor_msgs::Image> pictures(space() + "/overlay");
  ASSERT_TRUE(feed_.waitForListeners(1));
  feed_.send(1);  // ground truth is alive from now on
  ASSERT_TRUE(pictures.waitForCount(1));
  feed_.sendLines(2);
  feed_.sendImage(2);
  ASSERT_TRUE(pictures.waitForCount(2)) << "of a frame that waits in vain";
  EXPECT_TRUE(shows(pictures.messages()[1], palette::kPlain, 160, kTrueRow));
  EXPECT_FALSE(shows(pictures.messages()[1], palette::kMissed, 160, kMissedRow));
}

TEST_F(OnlineViewer, MarkersFollowPassesAndResets) {
  ASSERT_TRUE(load());
  Collector<MarkerArray> arrays(space() + "/markers");
  ASSERT_TRUE(feed_.waitForListeners(1));
  std::size_t count = 0;
  const auto next = [&](double second) {
    feed_.send(second);
    EXPECT_TRUE(arrays.waitForCount(++count));
    return arrays.messages().back();
  };
  feed_.sendCamera(0);
  EXPECT_TRUE(deletesAll(next(5))) << "RViz may show what another viewer has left";
  const MarkerArray second = next(6);
  EXPECT_FALSE(deletesAll(second));
  const auto markers = byName(second);
  EXPECT_EQ(markers.at("true_positives").points.size(), 2U);
  EXPECT_EQ(markers.at("false_positives").points.size(), 2U);
  EXPECT_EQ(markers.at("misses").points.size(), 2U);
  EXPECT_EQ(markers.at("not_scored").action, Marker::DELETE);
  EXPECT_EQ(markers.at("misses").header.frame_id, "camera_optical");
  EXPECT_NEAR(markers.at("misses").points[0].x, (40 - 160) / 200.0, 1e-12);
  EXPECT_TRUE(deletesAll(next(1))) << "time jumped back";
  EXPECT_FALSE(deletesAll(next(2)));

  feed_.sendFigures(7);
  feed_.sendFigures(0);
  EXPECT_TRUE(waitFor("a deletion after the evaluator's reset, without another frame", [&] {
    const std::vector<MarkerArray> messages = arrays.messages();
    return std::any_of(messages.begin() + static_cast<std::ptrdiff_t>(count), messages.end(),
                       deletesAll);
  }));
}

TEST_F(OnlineViewer, TrailsFollowMatches) {
  ASSERT_TRUE(load());
  Collector<MarkerArray> arrays(space() + "/markers");
  ASSERT_TRUE(feed_.waitForListeners(1));
  feed_.sendMatches(0, 1);
  feed_.send(1);
  ASSERT_TRUE(arrays.waitForCount(1));
  feed_.sendMatches(1, 2);
  feed_.send(2);
  ASSERT_TRUE(arrays.waitForCount(2));
  const auto markers = byName(arrays.messages()[1]);
  EXPECT_EQ(markers.at("trails").action, Marker::ADD);
  EXPECT_EQ(markers.at("trails").points.size(), 2U);
}

TEST_F(OnlineViewer, NamesWhatNeverPairs) {
  set("queue_size", 3);
  ASSERT_TRUE(load());
  Collector<sensor_msgs::Image> pictures(space() + "/overlay");
  ASSERT_TRUE(feed_.waitForListeners(1));
  const LogReader log;
  feed_.sendImage(1);
  for (int i = 0; i < 5; ++i) {
    feed_.sendLines(10 + i);
  }
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN,
                          {"lines at 10.0", "no image of exactly this stamp", "~queue_size"}));
}

TEST_F(OnlineViewer, NamesWhatItRefuses) {
  const auto expectRefusal = [&](const std::string& name, const std::string& key, const auto& value,
                                 const std::vector<std::string>& parts) {
    SCOPED_TRACE(key);
    ros::param::set(space() + "/" + name + "/" + key, value);
    const LogReader log;
    EXPECT_FALSE(load(name));
    EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, parts));
  };
  expectRefusal("misspelt", "treshold", 5, {"'treshold'", "threshold"});
  expectRefusal("out_of_range", "scale", 100.0, {"'scale'", "100", "8"});
}

}  // namespace
}  // namespace evolin::test
