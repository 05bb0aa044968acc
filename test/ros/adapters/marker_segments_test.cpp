// Markers to segments and back.
#include "marker_segments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spatial_markers.h"
#include "test/support/expect_error.h"
#include "view_markers.h"

namespace evolin::ros_shell {
namespace {

using test::expectError;

visualization_msgs::Marker lineList(const std::vector<Eigen::Vector3d>& points) {
  visualization_msgs::Marker marker;
  marker.type = visualization_msgs::Marker::LINE_LIST;
  for (const Eigen::Vector3d& point : points) {
    geometry_msgs::Point copy;
    copy.x = point.x();
    copy.y = point.y();
    copy.z = point.z();
    marker.points.push_back(copy);
  }
  return marker;
}

TEST(MarkerSegments, ComeTwoByTwo) {
  // The quaternion of a marker that nobody filled in is all zero.
  const auto segments = segmentsOf(lineList({{0, 0, 1}, {1, 0, 2}, {3, 4, 5}, {6, 7, 8}}));
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].p2, Eigen::Vector3d(1, 0, 2));
  EXPECT_EQ(segments[1].p1, Eigen::Vector3d(3, 4, 5));
}

TEST(MarkerSegments, AreWhereTheMarkersPoseIs) {
  visualization_msgs::Marker marker = lineList({{1, 0, 0}, {0, 1, 0}});
  marker.pose.position.z = 5;
  marker.pose.orientation.z = marker.pose.orientation.w = std::sqrt(0.5);  // x to y
  const auto segments = segmentsOf(marker);
  EXPECT_LT((segments[0].p1 - Eigen::Vector3d(0, 1, 5)).norm(), 1e-15);
  EXPECT_LT((segments[0].p2 - Eigen::Vector3d(-1, 0, 5)).norm(), 1e-15);
}

TEST(MarkerSegments, RefuseWhatIsNoLineList) {
  visualization_msgs::Marker marker = lineList({{0, 0, 1}, {1, 0, 2}, {3, 4, 5}});
  expectError([&] { segmentsOf(marker); }, {"3 points", "even"});
  marker.type = visualization_msgs::Marker::LINE_STRIP;
  expectError([&] { segmentsOf(marker); }, {"type 4", "LINE_LIST"});
  marker = lineList({});
  marker.pose.orientation.w = NAN;
  expectError([&] { segmentsOf(marker); }, {"quaternion"});
}

TEST(SpatialMarkers, HaveOneMarkerAGroupAndComeBack) {
  std_msgs::Header header;
  header.frame_id = "world";
  std::vector<SegmentGroup> groups = emptyGroups();
  groups[0].segments = {{{0, 1, 2}, {3, 4, 5}}, {{6, 7, 8}, {9, 8, 7}}};
  const visualization_msgs::MarkerArray array = markersOf(header, groups, 0.02);
  ASSERT_EQ(array.markers.size(), 4U);
  EXPECT_EQ(array.markers[0].ns, "true_positive");
  EXPECT_EQ(array.markers[0].action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(array.markers[0].scale.x, 0.02);
  EXPECT_EQ(array.markers[0].header.frame_id, "world");
  const auto segments = segmentsOf(array.markers[0]);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[1].p2, Eigen::Vector3d(9, 8, 7));
  EXPECT_EQ(array.markers[1].ns, "false_positive");
  EXPECT_EQ(array.markers[1].action, visualization_msgs::Marker::DELETE) << "the last frame's";
  EXPECT_EQ(noMarkers(header).markers.at(0).action, visualization_msgs::Marker::DELETEALL);
}

}  // namespace
}  // namespace evolin::ros_shell
