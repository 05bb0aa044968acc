// How many pixels of an ELSED segment have a gradient that stands across it.
#pragma once

#include "elsed_drawing.h"

namespace evolin::elsed {

struct Verdict {
  int agreeing = 0;
  int disagreeing = 0;
};

/// Looks at the inliers of the segment but those near its ends. The gradient is interpolated where
/// the pixel meets the line; it agrees when it differs by at most `threshold` radians (below
/// pi / 2) from the line's normal, whichever way.
Verdict validate(const Drawing& drawing, const DrawnSegment& segment, const GradientMaps& maps,
                 double threshold);

}  // namespace evolin::elsed
