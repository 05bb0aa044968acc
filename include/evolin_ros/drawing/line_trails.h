// Where matched lines have been in the last frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// `points` are midpoints in pixels, the oldest first; the last is that of line `row` of the frame.
struct LineTrail {
  std::int64_t track = 0;  ///< the line's id, or a number of the trail's own where it has none
  std::uint32_t row = 0;
  std::vector<cv::Point2d> points;
};

/// Follows the lines of one source by matches between frames any number of frames apart. Memory is
/// bounded by the frames remembered.
class LineTrails {
 public:
  /// A trail has at most `length` points; matches may reach `frames` frames back.
  LineTrails(std::size_t length, std::size_t frames) : length_(length), frames_(frames) {}

  /// Takes the next frame, whose lines matches join to an earlier one: trails of those that they
  /// follow, by row. Matches of a frame that is not remembered, or of rows that are not there, join
  /// nothing. Of several matches of one line the first counts.
  std::vector<LineTrail> add(Stamp stamp, const LineSegments& lines, Stamp first_stamp,
                             const LineMatches& matches);

  /// The next frame without matches.
  void add(Stamp stamp, const LineSegments& lines);

  /// By the lines' own ids: those of the frame before that are here again. Throws as
  /// pairsOfEqualIds().
  std::vector<LineTrail> addById(Stamp stamp, const LineSegments& lines);

  /// For a jump in time.
  void clear() { remembered_.clear(); }

 private:
  struct Frame {
    Stamp stamp;
    std::vector<LineTrail> trails;  ///< one a line
    LineSegments lines;
  };

  void remember(Frame frame);

  std::size_t length_;
  std::size_t frames_;
  std::int64_t next_track_ = 0;
  std::deque<Frame> remembered_;
};

}  // namespace evolin
