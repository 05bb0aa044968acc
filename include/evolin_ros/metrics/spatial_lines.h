// Detected lines of a frame together with where they are in space, and their projections into
// other frames: what all kinds of repeatability start from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/pose.h"
#include "evolin_ros/geometry/projection.h"
#include "evolin_ros/metrics/protocol.h"

namespace evolin {

struct SpatialLine {
  LineSegment segment;   ///< pixels; brought inside the image
  bool in_image = true;  ///< false: nothing of it is inside the image (kPaper), `segment` is raw
  std::optional<Segment3d> endpoints;  ///< metres, in the camera's frame; none without depth
};

/// About 120 bytes a line; no image.
struct SpatialFrame {
  Protocol protocol = Protocol::kEvolin;
  ImageSize size;
  Camera camera;
  Pose pose;                       ///< camera to world
  std::vector<SpatialLine> lines;  ///< one a detected line, in its row
};

/// Lifts `lines` (pixels of the image that `depth` belongs to) into space. kEvolin clamps their
/// coordinates to the image, takes depth at the endpoints rounded half to even and lifts the
/// rounded endpoints; kPaper clips the segments and lifts the endpoints themselves. No line is
/// dropped. The size of the image is that of the depth; the camera's own is not looked at. Throws
/// Error naming `frame_name` and the row for a line that is not finite, and for a focal length of
/// zero.
SpatialFrame liftLines(Protocol protocol, const std::string& frame_name, const LineSegments& lines,
                       const DepthMap& depth, const Camera& camera, const Pose& pose);

struct LineProjection {
  LineSegment segment;    ///< pixels of the image that it was projected into, brought inside it
  std::uint32_t row = 0;  ///< of the line that was projected
};

/// Images of `from`'s lines in `to`, by rising row, without those that have no depth or nothing
/// inside the image. Besides, kEvolin drops those with x1 == x2 or y1 == y2, both before and after
/// clamping (so every exactly horizontal or vertical one), and takes points behind the camera as
/// they come; kPaper drops those with an endpoint behind the camera and those of zero length. Lines
/// whose score is at most `score_threshold` are passed over (NaN: none is). Throws Error when the
/// protocols differ.
std::vector<LineProjection> projectLines(const SpatialFrame& from, const SpatialFrame& to,
                                         double score_threshold = kNoScore);

}  // namespace evolin
