// The adapters on messages made by hand: what they wait for, what they refuse, and what they send.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <ros/param.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <limits>
#include <set>

#ifdef EVOLIN_HAS_OPENCV_APPS
#include <opencv_apps/LineArrayStamped.h>
#endif

#include "conversions.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "evolin_ros/geometry/image_view.h"
#include "marker_segments.h"
#include "online_diagnostics.h"
#include "online_stream.h"

namespace evolin::test {
namespace {

Camera bentCamera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 458;
  camera.cx = 320;
  camera.cy = 240;
  camera.distortion = {-0.28, 0.07, 0.0002, 0.00002};
  return camera;
}

/// An adapter in its manager, with a publisher of its input and one of camera_info.
template <class Message>
class Adapter {
 public:
  Adapter(const std::string& type, const std::string& topic)
      : space_(testNamespace()), manager_(space_), type_(type), topic_(topic) {
    ros::NodeHandle handle(space_);
    input_ = handle.advertise<Message>(topic, 1000);
    camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 1000);
    lines_ = std::make_unique<Collector<evolin_ros::LineArray>>(space_ + "/lines");
  }

  template <class Value>
  void set(const std::string& name, const Value& value) {
    ros::param::set(space_ + "/adapter/" + name, value);
  }

  bool load() { return manager_.load("adapter", "evolin_ros/" + type_); }

  void start() {
    ASSERT_TRUE(load());
    ASSERT_TRUE(lines_->waitForPublisher());
    ASSERT_TRUE(waitFor("the adapter", [&] { return input_.getNumSubscribers() > 0; }));
  }

  void send(const Message& message) { input_.publish(message); }

  void sendCamera(const Camera& camera) {
    std_msgs::Header header;
    header.frame_id = "cam0";
    sendCamera(ros_shell::toMessage(camera, header));
  }

  void sendCamera(const sensor_msgs::CameraInfo& message) {
    ASSERT_TRUE(waitFor("the adapter at camera_info",
                        [&] { return camera_info_.getNumSubscribers() > 0; }));
    camera_info_.publish(message);
  }

  Manager& manager() { return manager_; }
  const std::string& space() const { return space_; }
  Collector<evolin_ros::LineArray>& lines() { return *lines_; }

 private:
  std::string space_;
  Manager manager_;
  std::string type_;
  std::string topic_;
  ros::Publisher input_;
  ros::Publisher camera_info_;
  std::unique_ptr<Collector<evolin_ros::LineArray>> lines_;
};

sensor_msgs::PointCloud cloudOf(int second, const std::vector<float>& codes) {
  sensor_msgs::PointCloud cloud;
  cloud.header.stamp = ros::Time(static_cast<std::uint32_t>(second), 0);
  cloud.header.frame_id = "world";
  cloud.channels.resize(3);
  for (const float code : codes) {
    geometry_msgs::Point32 start;
    start.x = 0.25F;
    start.y = -0.125F;
    start.z = 1;
    cloud.points.push_back(start);
    cloud.channels[0].values.push_back(code);
    cloud.channels[1].values.push_back(0.5F);
    cloud.channels[2].values.push_back(0.375F);
  }
  return cloud;
}

TEST(OnlineAdapters, CloudsWaitForTheCamera) {
  LogReader log;
  Adapter<sensor_msgs::PointCloud> adapter("PointCloudLines", "linefeature");
  adapter.set("queue_size", 2);
  adapter.set("pixels", "rectified");
  adapter.set("source", "tracker");
  Collector<evolin_ros::LineMatchArray> matches(adapter.space() + "/matches");
  ASSERT_NO_FATAL_FAILURE(adapter.start());
  ASSERT_TRUE(matches.waitForPublisher());
  for (const int second : {1, 2, 3}) {
    adapter.send(cloudOf(second, {4, 7}));
  }
  EXPECT_TRUE(
      log.waitFor(rosgraph_msgs::Log::WARN, {"/linefeature", "given up: 1", "camera_info"}));
  sensor_msgs::CameraInfo uncalibrated = ros_shell::toMessage(bentCamera(), {});
  uncalibrated.K.fill(0);
  uncalibrated.P.fill(0);
  adapter.sendCamera(uncalibrated);
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"/camera_info", "uncalibrated"}));
  EXPECT_EQ(adapter.lines().count(), 0U);
  adapter.sendCamera(bentCamera());
  ASSERT_TRUE(adapter.lines().waitForCount(2));
  const std::vector<evolin_ros::LineArray> lines = adapter.lines().messages();
  EXPECT_EQ(lines[0].header.stamp.sec, 2U) << "the oldest had to go";
  EXPECT_EQ(lines[1].header.stamp.sec, 3U);
  EXPECT_EQ(lines[0].header.frame_id, "cam0");
  ASSERT_EQ(lines[0].lines.size(), 2U);
  EXPECT_NEAR(lines[0].lines[0].x1, 320 + 458 * 0.25, 1e-9) << "rectified: not bent";
  EXPECT_NEAR(lines[0].lines[0].y2, 240 + 458 * 0.375, 1e-9);
  EXPECT_EQ(lines[0].lines[1].id, 7);
  EXPECT_TRUE(std::isnan(lines[0].lines[0].score));
  ASSERT_TRUE(matches.waitForCount(1));
  EXPECT_EQ(matches.messages()[0].first_stamp.sec, 2U);
  EXPECT_EQ(matches.messages()[0].matches.size(), 2U);
  EXPECT_EQ(matches.messages()[0].lines_source, "tracker");
}

TEST(OnlineAdapters, CloudsOfAnotherKindAreRefusedByName) {
  LogReader log;
  Adapter<sensor_msgs::PointCloud> adapter("PointCloudLines", "linefeature");
  adapter.set("camera", "tum_fr1");
  adapter.set("frame_id", "/cam");
  ASSERT_NO_FATAL_FAILURE(adapter.start());
  sensor_msgs::PointCloud points = cloudOf(1, {1});
  points.channels.resize(5);
  adapter.send(points);
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"/linefeature", "1.0", "5 channels"}));
  adapter.send(cloudOf(2, {1, 2.5F, -4}));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"2 lines left out", "2.5"}));
  ASSERT_TRUE(adapter.lines().waitForCount(1));
  EXPECT_EQ(adapter.lines().messages()[0].lines.size(), 1U);
  EXPECT_EQ(adapter.lines().messages()[0].header.frame_id, "cam");
}

TEST(OnlineAdapters, WhatIsRefusedStandsOnDiagnostics) {
  using Status = DiagnosticsReader::Status;
  Adapter<sensor_msgs::PointCloud> adapter("PointCloudLines", "linefeature");
  adapter.set("camera", "tum_fr1");
  adapter.set("diagnostic_period", 0.1);
  const DiagnosticsReader diagnostics(adapter.space() + "/adapter");
  ASSERT_NO_FATAL_FAILURE(adapter.start());
  sensor_msgs::PointCloud points = cloudOf(1, {1});
  points.channels.resize(5);
  adapter.send(points);
  adapter.send(cloudOf(2, {1}));
  EXPECT_TRUE(diagnostics.waitFor("drops", [](const Status& status) {
    return status.level == Status::ERROR && DiagnosticsReader::valueOf(status, "refused") == "1";
  }));
  EXPECT_TRUE(diagnostics.waitFor("latency", [](const Status& status) {
    return DiagnosticsReader::valueOf(status, "results") == "1";
  }));
}

TEST(OnlineAdapters, ParametersAreChecked) {
  LogReader log;
  Adapter<sensor_msgs::PointCloud> adapter("PointCloudLines", "linefeature");
  adapter.set("camera_index", 2);
  adapter.set("number_of_cameras", 2);
  EXPECT_FALSE(adapter.load());
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::FATAL, {"camera_index", "0 to 1"}));
  adapter.set("camera_index", 1);
  adapter.set("pixel", "distorted");
  EXPECT_FALSE(adapter.load());
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::FATAL, {"'pixel'", "pixels"}));
}

visualization_msgs::Marker markerOf(int second, const std::vector<Segment3d>& segments) {
  visualization_msgs::Marker marker;
  marker.header.stamp = ros::Time(static_cast<std::uint32_t>(second), 0);
  marker.header.frame_id = "/cam0";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.pose.orientation.w = 1;
  for (const Segment3d& segment : segments) {
    for (const Eigen::Vector3d& from : {segment.p1, segment.p2}) {
      geometry_msgs::Point point;
      point.x = from.x();
      point.y = from.y();
      point.z = from.z();
      marker.points.push_back(point);
    }
  }
  return marker;
}

TEST(OnlineAdapters, MarkersAreProjected) {
  LogReader log;
  Adapter<visualization_msgs::Marker> adapter("MarkerLines", "marker");
  ASSERT_NO_FATAL_FAILURE(adapter.start());
  adapter.sendCamera(bentCamera());
  const std::vector<Segment3d> segments = {{{-0.5, 0.2, 2}, {0.6, -0.3, 3}},
                                           {{0, 0, -1}, {1, 1, -2}},  // behind the camera
                                           {{-5, 0.4, 2}, {5, 0.4, 2}}};
  adapter.send(markerOf(1, segments));
  ASSERT_TRUE(adapter.lines().waitForCount(1));
  const evolin_ros::LineArray array = adapter.lines().messages()[0];
  EXPECT_EQ(array.header.stamp.sec, 1U);
  EXPECT_EQ(array.header.frame_id, "cam0");
  EXPECT_EQ(array.source, "markers");
  EXPECT_EQ(array.width, 640U);
  ASSERT_EQ(array.lines.size(), 2U);
  const ImageView view = ImageView::distorted(bentCamera());
  for (const std::size_t row : {0, 1}) {
    const LineSegment expected = view.project(segments[2 * row], 0.05).value();
    EXPECT_NEAR(array.lines[row].x1, expected.x1, 1e-9);
    EXPECT_NEAR(array.lines[row].y1, expected.y1, 1e-9);
    EXPECT_NEAR(array.lines[row].x2, expected.x2, 1e-9);
    EXPECT_NEAR(array.lines[row].y2, expected.y2, 1e-9);
  }
  visualization_msgs::Marker elsewhere = markerOf(2, segments);
  elsewhere.header.frame_id = "map";
  adapter.send(elsewhere);
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"/marker", "2.0", "'map'", "'cam0'"}));
  visualization_msgs::Marker removal = markerOf(3, {});
  removal.action = visualization_msgs::Marker::DELETEALL;
  adapter.send(removal);
  adapter.send(markerOf(4, {}));
  ASSERT_TRUE(adapter.lines().waitForCount(2));
  EXPECT_EQ(adapter.lines().messages()[1].header.stamp.sec, 4U) << "a frame without lines";
}

#ifdef EVOLIN_HAS_OPENCV_APPS
TEST(OnlineAdapters, LinesOfOpencvAppsComeAndGo) {
  Adapter<opencv_apps::LineArrayStamped> adapter("OpencvAppsLines", "opencv_apps_lines");
  ASSERT_NO_FATAL_FAILURE(adapter.start());
  opencv_apps::LineArrayStamped foreign;
  foreign.header.stamp = ros::Time(7, 5);
  foreign.header.frame_id = "usb_cam";
  foreign.lines.resize(2);
  foreign.lines[1].pt1.x = 1.25;
  foreign.lines[1].pt1.y = 2.5;
  foreign.lines[1].pt2.x = 3.75;
  foreign.lines[1].pt2.y = 5.125;
  adapter.send(foreign);
  // Held back until the size is known; an uncalibrated camera tells it.
  sensor_msgs::CameraInfo uncalibrated;
  uncalibrated.width = 320;
  uncalibrated.height = 240;
  adapter.sendCamera(uncalibrated);
  ASSERT_TRUE(adapter.lines().waitForCount(1));
  const evolin_ros::LineArray array = adapter.lines().messages()[0];
  EXPECT_EQ(array.header.stamp, foreign.header.stamp);
  EXPECT_EQ(array.header.frame_id, "usb_cam");
  EXPECT_EQ(array.width, 320U);
  EXPECT_EQ(array.height, 240U);
  EXPECT_EQ(array.source, "opencv_apps");
  ASSERT_EQ(array.lines.size(), 2U);
  EXPECT_EQ(array.lines[1].x1, 1.25);
  EXPECT_EQ(array.lines[1].y1, 2.5);
  EXPECT_EQ(array.lines[1].x2, 3.75);
  EXPECT_EQ(array.lines[1].y2, 5.125);
  EXPECT_EQ(array.lines[1].id, kNoId);

  ros::param::set(adapter.space() + "/back/direction", "to");
  ros::param::set(adapter.space() + "/back/diagnostic_period", 0.1);
  ros::param::set(adapter.space() + "/back/warn_after", 0.1);
  const DiagnosticsReader diagnostics(adapter.space() + "/back");
  const LogReader log;
  Collector<opencv_apps::LineArrayStamped> back(adapter.space() + "/back_lines");
  ASSERT_TRUE(adapter.manager().load("back", "evolin_ros/OpencvAppsLines",
                                     {{"opencv_apps_lines", "back_lines"}}));
  ASSERT_TRUE(back.waitForPublisher());
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"/lines", "Remap 'lines'"}));
  adapter.send(foreign);
  ASSERT_TRUE(back.waitForCount(1));
  EXPECT_TRUE(diagnostics.waitFor("latency", [](const DiagnosticsReader::Status& status) {
    return DiagnosticsReader::valueOf(status, "results") == "1";
  }));
  EXPECT_EQ(back.messages()[0].header.frame_id, "usb_cam");
  ASSERT_EQ(back.messages()[0].lines.size(), 2U);
  EXPECT_EQ(back.messages()[0].lines[1].pt2.y, 5.125);
}
#else
TEST(OnlineAdapters, WithoutOpencvAppsItsAdapterSaysSo) {
  LogReader log;
  Adapter<sensor_msgs::PointCloud> adapter("OpencvAppsLines", "none");
  EXPECT_FALSE(adapter.load());
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::FATAL, {"no opencv_apps", "install"}));
}
#endif

/// Shortest distance to any edge of the scene, as a share of `depth`.
double offEdges(const synthetic::Scene& scene, const Eigen::Vector3d& point, double depth) {
  double least = std::numeric_limits<double>::infinity();
  for (const synthetic::Edge& edge : scene.edges) {
    const Eigen::Vector3d along = (edge.to - edge.from).normalized();
    const Eigen::Vector3d offset = point - edge.from;
    least = std::min(least, (offset - offset.dot(along) * along).norm());
  }
  return least / depth;
}

TEST(OnlineAdapters, LinesInSpaceLieOnTheRoomsEdges) {
  const synthetic::SyntheticSequence sequence({});
  const SequenceFrame frame = sequence.frame(5);
  const std::string space = testNamespace();
  Manager manager(space);
  ros::param::set(space + "/lines_3d/fixed_frame", "/room");
  Collector<visualization_msgs::MarkerArray> markers(space + "/lines_3d");
  ASSERT_TRUE(manager.load("lines_3d", "evolin_ros/Lines3d"));
  ASSERT_TRUE(markers.waitForPublisher());
  ros::NodeHandle handle(space);
  ros::Publisher lines = handle.advertise<evolin_ros::LineArray>("lines", 10);
  ros::Publisher truth = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", 10);
  ros::Publisher depth = handle.advertise<sensor_msgs::Image>("depth", 10);
  ros::Publisher camera_info = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 10);
  ros::Publisher tf = handle.advertise<tf2_msgs::TFMessage>("/tf", 10);
  for (const ros::Publisher& publisher : {lines, truth, depth, camera_info, tf}) {
    ASSERT_TRUE(waitFor("the nodelet on " + publisher.getTopic(),
                        [&] { return publisher.getNumSubscribers() > 0; }));
  }

  // The first 40 annotated lines are detected, the others missed; three more are invented.
  LineSet annotated = groundTruthOf(frame);
  annotated.frame_id = "room_camera";
  LineSet found = annotated;
  found.source = "detector";
  found.lines.resize(40);
  for (const double shift : {0.0, 20.0, 40.0}) {
    LineSegment invented;
    invented.x1 = 300 + shift;
    invented.y1 = 20 + shift;
    invented.x2 = 308 + shift;
    invented.y2 = 27 + shift;
    found.lines.push_back(invented);
  }
  std_msgs::Header header;
  header.stamp = ros_shell::toRosTime(frame.frame.stamp);
  header.frame_id = "room_camera";
  camera_info.publish(ros_shell::toMessage(sequence.camera(), header));
  depth.publish(
      cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_32FC1, frame.frame.depth)
          .toImageMsg());
  truth.publish(ros_shell::toMessage(annotated));
  lines.publish(ros_shell::toMessage(found));
  const Pose pose = sequence.pose(5);
  tf2_msgs::TFMessage transform;
  transform.transforms.resize(1);
  transform.transforms[0].header = header;
  transform.transforms[0].header.frame_id = "room";
  transform.transforms[0].child_frame_id = "room_camera";
  const geometry_msgs::Pose at = ros_shell::toMessage(pose);
  transform.transforms[0].transform.translation.x = at.position.x;
  transform.transforms[0].transform.translation.y = at.position.y;
  transform.transforms[0].transform.translation.z = at.position.z;
  transform.transforms[0].transform.rotation = at.orientation;
  tf.publish(transform);

  ASSERT_TRUE(markers.waitForCount(1));
  const visualization_msgs::MarkerArray array = markers.messages()[0];
  std::map<std::string, std::vector<Segment3d>> groups;
  for (const visualization_msgs::Marker& marker : array.markers) {
    EXPECT_EQ(marker.header.frame_id, "room");
    EXPECT_EQ(marker.header.stamp, header.stamp);
    groups[marker.ns] = ros_shell::segmentsOf(marker);
  }
  std::size_t far_off = 0;
  std::size_t ends = 0;
  for (const char* group : {"true_positive", "missed"}) {
    for (const Segment3d& segment : groups[group]) {
      for (const Eigen::Vector3d& point : {segment.p1, segment.p2}) {
        ++ends;
        far_off +=
            offEdges(sequence.scene(), point, (point - pose.translation).norm()) > 0.02 ? 1 : 0;
      }
    }
  }
  EXPECT_LT(far_off, ends / 20) << "of " << ends;
  EXPECT_GE(groups["true_positive"].size() + 3, 40U);
  EXPECT_LE(groups["true_positive"].size(), 40U);
  EXPECT_EQ(groups["false_positive"].size(), 3U);
  EXPECT_GE(groups["missed"].size() + 5, annotated.lines.size() - 40);
  EXPECT_LE(groups["missed"].size(), annotated.lines.size() - 40 + 3);
}

}  // namespace
}  // namespace evolin::test
