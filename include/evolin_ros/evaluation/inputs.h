// What the evaluation takes in: the lines of one image and the matches between two.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// All lines of one image, by a detector or as ground truth.
struct LineSet {
  Stamp stamp = 0;
  std::string frame_id;  ///< coordinate frame of the camera, for messages
  std::string source;    ///< who made the lines
  int width = 0;         ///< image size in pixels
  int height = 0;
  bool scored = false;         ///< every line carries a score
  double processing_time = 0;  ///< seconds of wall time; 0: not measured
  LineSegments lines;
};

/// Matches between the lines of two images, by index.
struct MatchSet {
  Stamp first_stamp = 0;
  Stamp stamp = 0;  ///< of the second image
  std::string frame_id;
  std::string source;        ///< the associator
  std::string lines_source;  ///< LineSet::source of the lines that the indices refer to
  double processing_time = 0;
  LineMatches matches;
};

/// A time as messages carry it; 0 (not measured) for what is none.
inline double measuredTime(double seconds) {
  return std::isfinite(seconds) && seconds > 0 ? seconds : 0;
}

/// Whether any line says which physical line or track it is.
inline bool hasIds(const LineSegments& lines) {
  return std::any_of(lines.begin(), lines.end(),
                     [](const LineSegment& line) { return line.id >= 0; });
}

}  // namespace evolin
