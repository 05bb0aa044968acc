// Of lines that run so near to each other that they look like one, one is kept.
#pragma once

#include <vector>

#include "evolin_ros/dataset/synthetic/visible_edges.h"

namespace evolin::synthetic {

/// A visible part of an edge in the image.
struct ProjectedPart {
  LineSegment line;
  std::size_t edge = 0;
  EdgePart exposed;   ///< the unhidden part of the edge that it belongs to
  EdgePart seen;      ///< what of it is in the picture: `line`
  double depth1 = 1;  ///< metres along the optical axis, at the line's two ends
  double depth2 = 1;
};

/// Goes from the longest line to the shortest and keeps of each what does not run for kMinLength or
/// more within kTwinDistance of a line already kept, in pieces of at least kMinLength. The result
/// is by edge and along it.
std::vector<VisibleLine> withoutTwins(std::vector<ProjectedPart> parts);

/// The stretch of `line` that is no farther than `distance` from the segment `other`, as shares of
/// the way from point 1 to point 2; empty (begin >= end) where there is none.
EdgePart stretchNear(const LineSegment& line, const LineSegment& other, double distance);

/// What is left of `whole` without `taken`, in order.
std::vector<EdgePart> complement(const EdgePart& whole, std::vector<EdgePart> taken);

}  // namespace evolin::synthetic
