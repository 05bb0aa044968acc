// How evenly lines fill the image: the share of the cells of a grid that they touch (not in the
// article; lines in one corner bind a camera's pose badly).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

struct SpreadGrid {
  int columns = 8;
  int rows = 6;
};

/// Cells of the grid that at least one line touches. The grid's cells are of equal size and cover
/// the whole pixels (from -0.5 to width - 0.5), a point between two cells touches both. Parts of
/// lines outside the image touch nothing; a line of zero length touches like a point. Throws Error
/// for a line that is not finite, an image without size, or a grid without cells.
std::size_t touchedCells(const std::string& frame_name, ImageSize size, const LineSegments& lines,
                         SpreadGrid grid = {});

/// An accumulator over frames: add in any order, read at any time, merge, reset.
class SpatialSpread {
 public:
  /// Throws Error for a grid without cells.
  explicit SpatialSpread(SpreadGrid grid = {});

  /// Returns the share of this frame, in [0, 1]; throws as touchedCells(), and adds nothing then.
  double addFrame(const std::string& frame_name, ImageSize size, const LineSegments& lines);

  std::size_t frames() const { return frames_; }

  /// Mean over frames, in [0, 1]; 0 without frames.
  double share() const;

  /// Throws Error when the grids differ.
  void merge(const SpatialSpread& other);
  void reset();

 private:
  SpreadGrid grid_;
  std::uint64_t touched_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace evolin
