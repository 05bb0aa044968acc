// The segment in space behind a segment of the image, from all the depth along it.
#pragma once

#include <optional>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

struct SegmentFitOptions {
  int positions =
      64;            ///< along the segment at which depth is read: one a pixel, but at most so many
  double reach = 2;  ///< pixels to both sides that are read: how far a detected line may lie beside
                     ///< its edge
  double tolerance = 0.02;   ///< share of the depth by which samples of one surface may differ
  double min_support = 0.5;  ///< share of the positions that must show the surface
  double max_slant = 85;     ///< degrees between a surface's normal and the ray, at most
};

/// Throws Error naming the option, its value and the accepted range.
void validate(const SegmentFitOptions& options);

struct SegmentFit {
  Segment3d segment;   ///< metres, in the camera's frame; the part inside the image
  double support = 0;  ///< share of the positions that show the surface
  double rms = 0;      ///< of the depth about the fit, as a share of the depth
};

/// Where liftEndpoints() and backProject() trust the depth at two single pixels, this takes the
/// depth of a band along the whole segment, so that holes, noise and pixels that belong to what is
/// behind the edge do no harm. Along the image of a line, and across that of a plane, the inverse
/// of depth grows evenly: of all straight courses of inverse depth that at least `min_support` of
/// the positions show, the nearest is taken (an edge belongs to the surface in front), by consensus
/// with a fixed order of trials; then the course and the slants of the surfaces at its two sides
/// are refined together by least squares on the samples that agree. The camera is a pinhole and
/// `depth` belongs to the same image as `segment`; distortion is not looked at. None for a segment
/// outside the image or with too little depth. The same input gives the same result. Throws Error
/// for a segment that is not finite and for a focal length of zero.
std::optional<SegmentFit> fitSegment(const Camera& camera, const LineSegment& segment,
                                     const DepthMap& depth, const SegmentFitOptions& options = {});

}  // namespace evolin
