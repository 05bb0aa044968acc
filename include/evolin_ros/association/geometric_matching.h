// Matching of lines by where they are, once it is known where each is expected.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

/// What two lines must have in common; each bound is inclusive.
struct GeometricGates {
  double max_angle = 10;     ///< degrees between their directions, whatever the endpoints' order
  double max_distance = 10;  ///< pixels: mean of the four distances from an endpoint to the other
                             ///< line, straight on
  double min_overlap = 0.3;  ///< share of the shorter one beside which the other lies
};

/// Reads the gates' parameters by their names.
void readGates(ParameterReader* reader, GeometricGates* gates);

/// How two segments lie to each other; the same for any order of segments and of endpoints.
struct SegmentRelation {
  double angle = 0;     ///< degrees, 0 to 90
  double distance = 0;  ///< as GeometricGates::max_distance
  double overlap = 0;   ///< share of the shorter one, 0 to 1
};

/// None when either has no length or is not finite.
std::optional<SegmentRelation> relate(const LineSegment& a, const LineSegment& b);

/// One to one: of all pairs within the gates the one that fits best first, then the best of what is
/// left; a pair's fit adds angle and distance as shares of their gates and the missing overlap, and
/// lower rows win ties. Sorted by the first index; `distance` of a match is the relation's, pixels.
/// `expected[i]` is where line i of the first frame should be in the second (none: not to be seen).
LineMatches matchGeometrically(const std::vector<std::optional<LineSegment>>& expected,
                               const LineSegments& second, const GeometricGates& gates);

using SpatialSegments = std::vector<std::optional<Segment3d>>;

/// Every line in space, metres in its camera's frame, by all the depth along it (fitSegment); none
/// for a line with too little. Images are rectified. Throws Error naming `owner` and the frame
/// where depth or camera is missing.
SpatialSegments liftIntoSpace(const FrameLines& lines, const char* owner);

/// Throws Error naming `owner` and both sizes where the frames' images differ in size.
void requireEqualSizes(const FrameLines& first, const FrameLines& second, const char* owner);

/// The motion from the camera of `first` to that of `second`. Throws Error naming `owner` and the
/// frame where a pose is missing.
Eigen::Isometry3d motionOf(const FrameLines& first, const FrameLines& second, const char* owner);

/// Where such lines of another frame should be seen by the camera of `second` after `motion`; none
/// behind the camera and outside the image. Throws Error naming `owner` and the frame where its
/// camera is missing.
std::vector<std::optional<LineSegment>> expectIn(const FrameLines& second,
                                                 const SpatialSegments& lines,
                                                 const Eigen::Isometry3d& motion,
                                                 const char* owner);

}  // namespace evolin
