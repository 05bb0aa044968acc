// Angle, distance and overlap of all pairs, then the best first.
#include "evolin_ros/association/geometric_matching.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/clipping.h"
#include "evolin_ros/geometry/projection.h"
#include "evolin_ros/geometry/segment_fit.h"

namespace evolin {

namespace {

constexpr double kDegrees = 180 / M_PI;

struct Axis {
  double x;  ///< unit direction
  double y;
  double length;
};

std::optional<Axis> axisOf(const LineSegment& line) {
  const double length = line.length();
  if (!line.isFinite() || !(length > 0)) {
    return std::nullopt;
  }
  return Axis{(line.x2 - line.x1) / length, (line.y2 - line.y1) / length, length};
}

double distanceTo(const LineSegment& line, const Axis& axis, double x, double y) {
  return std::abs((x - line.x1) * axis.y - (y - line.y1) * axis.x);
}

double alongTo(const LineSegment& line, const Axis& axis, double x, double y) {
  return (x - line.x1) * axis.x + (y - line.y1) * axis.y;
}

/// Pixels of `line` beside which `other` lies.
double sharedLength(const LineSegment& line, const Axis& axis, const LineSegment& other) {
  const double a = alongTo(line, axis, other.x1, other.y1);
  const double b = alongTo(line, axis, other.x2, other.y2);
  return std::max(0.0, std::min(axis.length, std::max(a, b)) - std::max(0.0, std::min(a, b)));
}

void demand(bool there, const char* owner, const Frame& frame, const char* what) {
  if (!there) {
    throw Error(std::string(owner) + ": the frame at " + formatStamp(frame.stamp) + " s has no " +
                what + ", which this method needs");
  }
}

}  // namespace

void readGates(ParameterReader* reader, GeometricGates* gates) {
  reader->read("max_angle", &gates->max_angle, 0, 90);
  reader->read("max_distance", &gates->max_distance, 0, 1e6);
  reader->read("min_overlap", &gates->min_overlap, 0, 1);
}

std::optional<SegmentRelation> relate(const LineSegment& a, const LineSegment& b) {
  const std::optional<Axis> along_a = axisOf(a);
  const std::optional<Axis> along_b = axisOf(b);
  if (!along_a || !along_b) {
    return std::nullopt;
  }
  SegmentRelation relation;
  const double sine = std::abs(along_a->x * along_b->y - along_a->y * along_b->x);
  const double cosine = std::abs(along_a->x * along_b->x + along_a->y * along_b->y);
  relation.angle = std::atan2(sine, cosine) * kDegrees;
  // Sums of two first: the same to the last bit with the endpoints or the segments swapped.
  relation.distance =
      ((distanceTo(a, *along_a, b.x1, b.y1) + distanceTo(a, *along_a, b.x2, b.y2)) +
       (distanceTo(b, *along_b, a.x1, a.y1) + distanceTo(b, *along_b, a.x2, a.y2))) /
      4;
  // Beside the shorter one; of two equally long ones beside the one that is overlapped less.
  relation.overlap =
      std::min(1.0, std::min(sharedLength(a, *along_a, b), sharedLength(b, *along_b, a)) /
                        std::min(along_a->length, along_b->length));
  return relation;
}

LineMatches matchGeometrically(const std::vector<std::optional<LineSegment>>& expected,
                               const LineSegments& second, const GeometricGates& gates) {
  struct Candidate {
    double misfit;
    LineMatch match;
  };
  const auto share = [](double value, double gate) { return gate > 0 ? value / gate : value; };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t j = 0; expected[i] && j < second.size(); ++j) {
      const std::optional<SegmentRelation> relation = relate(*expected[i], second[j]);
      if (!relation || relation->angle > gates.max_angle ||
          relation->distance > gates.max_distance || relation->overlap < gates.min_overlap) {
        continue;
      }
      Candidate candidate;
      candidate.misfit = share(relation->angle, gates.max_angle) +
                         share(relation->distance, gates.max_distance) + (1 - relation->overlap);
      candidate.match.first = static_cast<std::uint32_t>(i);
      candidate.match.second = static_cast<std::uint32_t>(j);
      candidate.match.distance = static_cast<float>(relation->distance);
      candidates.push_back(candidate);
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.misfit, a.match.first, a.match.second) <
           std::tie(b.misfit, b.match.first, b.match.second);
  });
  std::vector<char> first_taken(expected.size(), 0);
  std::vector<char> second_taken(second.size(), 0);
  LineMatches matches;
  for (const Candidate& candidate : candidates) {
    char& first = first_taken[candidate.match.first];
    char& other = second_taken[candidate.match.second];
    if (first == 0 && other == 0) {
      first = other = 1;
      matches.push_back(candidate.match);
    }
  }
  std::sort(matches.begin(), matches.end(),
            [](const LineMatch& a, const LineMatch& b) { return a.first < b.first; });
  return matches;
}

void requireEqualSizes(const FrameLines& first, const FrameLines& second, const char* owner) {
  const cv::Size a = first.frame.image.size();
  const cv::Size b = second.frame.image.size();
  if (a != b) {
    throw Error(std::string(owner) + ": the images are " + std::to_string(a.width) + "x" +
                std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                std::to_string(b.height) + ", expected one size");
  }
}

SpatialSegments liftIntoSpace(const FrameLines& lines, const char* owner) {
  demand(lines.frame.camera.has_value(), owner, lines.frame, "camera");
  demand(!lines.frame.depth.empty(), owner, lines.frame, "depth");
  const DepthMap depth(lines.frame.depth);
  SpatialSegments lifted(lines.lines.size());
  for (std::size_t i = 0; i < lifted.size(); ++i) {
    if (!axisOf(lines.lines[i])) {
      continue;
    }
    if (const auto fit = fitSegment(*lines.frame.camera, lines.lines[i], depth)) {
      lifted[i] = fit->segment;
    }
  }
  return lifted;
}

Eigen::Isometry3d motionOf(const FrameLines& first, const FrameLines& second, const char* owner) {
  demand(first.frame.pose.has_value(), owner, first.frame, "pose");
  demand(second.frame.pose.has_value(), owner, second.frame, "pose");
  return motionBetween(*first.frame.pose, *second.frame.pose);
}

std::vector<std::optional<LineSegment>> expectIn(const FrameLines& second,
                                                 const SpatialSegments& lines,
                                                 const Eigen::Isometry3d& motion,
                                                 const char* owner) {
  demand(second.frame.camera.has_value(), owner, second.frame, "camera");
  const Camera& camera = *second.frame.camera;
  const cv::Mat& image = second.frame.image;
  std::vector<std::optional<LineSegment>> expected(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::optional<LineSegment> seen =
        lines[i] ? project(camera, *lines[i], motion, true) : std::nullopt;
    if (seen) {
      expected[i] = clipToRectangle(*seen, {0.0, 0.0, image.cols - 1.0, image.rows - 1.0});
    }
  }
  return expected;
}

}  // namespace evolin
