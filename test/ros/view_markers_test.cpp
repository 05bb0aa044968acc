// Markers of a frame: namespaces and ids that stay, points on the image plane, deletions.
#include "view_markers.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

namespace evolin::ros_shell {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

LineSegment line(double x1, double y1, double x2, double y2) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  return result;
}

Camera camera() {
  Camera result;
  result.fx = 500;
  result.fy = 250;
  result.cx = 320;
  result.cy = 240;
  return result;
}

EvaluatedFrame sample() {
  EvaluatedFrame frame;
  frame.image = cv::Mat(480, 640, CV_8UC1, cv::Scalar::all(0));
  frame.lines = {line(320, 240, 420, 240), line(1, 1, 2, 2), line(3, 3, 4, 4)};
  frame.ground_truth = {line(5, 5, 6, 6), line(320, 240, 420, 240)};
  frame.verdicts.predicted = {LineVerdict::kTruePositive, LineVerdict::kFalsePositive,
                              LineVerdict::kFalsePositive};
  frame.verdicts.found = {false, true};
  frame.trails = {{4, 0, {{10, 10}, {20, 20}, {30, 30}}}};
  return frame;
}

std_msgs::Header header() {
  std_msgs::Header result;
  result.frame_id = "/camera_optical";
  result.stamp = ros::Time(3, 4);
  return result;
}

MarkerArray make(const EvaluatedFrame& frame, bool anew = false, const ViewOptions& options = {}) {
  return toMarkers(header(), camera(), 2, frame, options, anew);
}

std::map<std::string, Marker> byName(const MarkerArray& array) {
  std::map<std::string, Marker> result;
  for (const Marker& marker : array.markers) {
    EXPECT_TRUE(result.emplace(marker.ns, marker).second) << marker.ns << " occurs twice";
    EXPECT_EQ(marker.id, 0);
    EXPECT_EQ(marker.header.frame_id, "camera_optical");
    EXPECT_EQ(marker.header.stamp, ros::Time(3, 4));
    EXPECT_TRUE(marker.colors.empty() || marker.colors.size() == marker.points.size());
  }
  return result;
}

TEST(ViewMarkers, OneListAKind) {
  const auto markers = byName(make(sample()));
  const std::map<std::string, std::size_t> points = {
      {"true_positives", 2}, {"false_positives", 4}, {"misses", 2},       {"not_scored", 0},
      {"detected", 0},       {"trails", 4},          {"image_border", 16}};
  ASSERT_EQ(markers.size(), points.size());
  for (const auto& [name, count] : points) {
    EXPECT_EQ(markers.at(name).points.size(), count) << name;
    EXPECT_EQ(markers.at(name).action, count > 0 ? Marker::ADD : Marker::DELETE) << name;
    EXPECT_EQ(markers.at(name).type, Marker::LINE_LIST);
  }
}

TEST(ViewMarkers, PointsLieOnTheImagePlane) {
  const Marker marker = byName(make(sample())).at("true_positives");
  EXPECT_DOUBLE_EQ(marker.points[0].x, 0);
  EXPECT_DOUBLE_EQ(marker.points[0].y, 0);
  EXPECT_DOUBLE_EQ(marker.points[0].z, 2);
  EXPECT_DOUBLE_EQ(marker.points[1].x, 100.0 / 500 * 2);
  const Marker border = byName(make(sample())).at("image_border");
  EXPECT_DOUBLE_EQ(border.points[0].y, (-0.5 - 240) / 250 * 2);
  EXPECT_DOUBLE_EQ(border.points[2].z, 0) << "from the camera's centre";
}

TEST(ViewMarkers, ANewPassDeletesAllFirst) {
  const MarkerArray array = make(sample(), true);
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  EXPECT_EQ(array.markers.size(), make(sample(), false).markers.size() + 1);
}

TEST(ViewMarkers, NamespacesStayWhateverTheFrameHolds) {
  EvaluatedFrame plain = sample();
  plain.verdicts = {};
  plain.no_verdicts = "no ground truth";
  plain.trails.clear();
  const auto markers = byName(make(plain));
  EXPECT_EQ(markers.size(), byName(make(sample())).size());
  EXPECT_EQ(markers.at("detected").points.size(), 6U);
  EXPECT_EQ(markers.at("true_positives").action, Marker::DELETE);
  EXPECT_EQ(markers.at("trails").action, Marker::DELETE);
}

TEST(ViewMarkers, LayersCanBeLeftOut) {
  ViewOptions options;
  options.misses = false;
  options.trails = false;
  const auto markers = byName(make(sample(), false, options));
  EXPECT_EQ(markers.at("misses").action, Marker::DELETE);
  EXPECT_EQ(markers.at("trails").action, Marker::DELETE);
  EXPECT_EQ(markers.at("false_positives").action, Marker::ADD);
}

TEST(ViewMarkers, LinesThatAreNotFiniteAreLeftOut) {
  EvaluatedFrame frame = sample();
  frame.verdicts = {};
  frame.no_verdicts = "not judged";
  frame.lines[1].x1 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(byName(make(frame)).at("detected").points.size(), 4U);
}

}  // namespace
}  // namespace evolin::ros_shell
