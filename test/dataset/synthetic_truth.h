// The synthetic sequence with its default options, its ground truth, and what tests ask about it.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "test/dataset/ray_oracle.h"

namespace evolin::test {

inline const synthetic::SyntheticSequence& defaultSequence() {
  static const synthetic::SyntheticSequence kSequence{synthetic::SyntheticOptions{}};
  return kSequence;
}

/// Of all 90 frames.
inline const std::vector<LineSegments>& defaultGroundTruth() {
  static const std::vector<LineSegments> kLines = [] {
    std::vector<LineSegments> frames;
    for (std::size_t i = 0; i < defaultSequence().size(); ++i) {
      frames.push_back(defaultSequence().groundTruth(i));
    }
    return frames;
  }();
  return kLines;
}

inline const synthetic::Edge& edgeOf(const LineSegment& line) {
  return defaultSequence().scene().edges[defaultSequence().edgeOf(line.id)];
}

/// Where on a physical edge, as a share of the way, the point is that is seen at a pixel: where the
/// edge comes nearest to the sight line.
inline double shareOfEdge(const synthetic::Edge& edge, const Camera& camera, const Pose& pose,
                          double x, double y) {
  const Eigen::Vector3d d = sightLine(camera, pose, x, y).normalized();
  const Eigen::Vector3d span = edge.to - edge.from;
  const Eigen::Vector3d offset = edge.from - pose.translation;
  const Eigen::Vector3d across = span - span.dot(d) * d;
  return -(offset - offset.dot(d) * d).dot(across) / across.squaredNorm();
}

inline Eigen::Vector3d pointOfEdge(const synthetic::Edge& edge, double share) {
  return edge.from + share * (edge.to - edge.from);
}

inline double distanceToSegment(double x, double y, const LineSegment& line) {
  const double dx = (line.x2 - line.x1) / line.length();
  const double dy = (line.y2 - line.y1) / line.length();
  const double along = std::clamp((x - line.x1) * dx + (y - line.y1) * dy, 0.0, line.length());
  return std::hypot(x - line.x1 - along * dx, y - line.y1 - along * dy);
}

}  // namespace evolin::test
