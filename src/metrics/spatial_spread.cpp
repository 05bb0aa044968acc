// Walking over grid cells column by column.
#include "evolin_ros/metrics/spatial_spread.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/clipping.h"
#include "scaling.h"

namespace evolin {

namespace {

void checkGrid(SpreadGrid grid) {
  if (grid.columns < 1 || grid.rows < 1) {
    throw Error("grid of " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                " cells: expected at least one column and one row");
  }
}

/// Index of the first cell [index, index + 1] that holds `position`, in units of cells.
int firstCell(double position, int count) {
  // A whole position lies on the border and belongs to the cell before it, too.
  const int cell = static_cast<int>(position);
  return std::clamp(cell - (cell == position ? 1 : 0), 0, count - 1);
}

int lastCell(double position, int count) {
  return std::clamp(static_cast<int>(position), 0, count - 1);
}

}  // namespace

std::size_t touchedCells(const std::string& frame_name, ImageSize size, const LineSegments& lines,
                         SpreadGrid grid) {
  checkGrid(grid);
  if (size.width <= 0 || size.height <= 0) {
    throw Error("image of frame " + frame_name + ": size " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + "; expected a positive number of pixels");
  }
  std::vector<bool> touched(static_cast<std::size_t>(grid.columns) * grid.rows, false);
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    if (!line.isFinite()) {
      throw Error("lines of frame " + frame_name + ", row " + std::to_string(row) + ": " +
                  coordinates(line) + " is not finite");
    }
    // In units of cells.
    LineSegment cells;
    cells.x1 = (line.x1 + 0.5) * grid.columns / size.width;
    cells.y1 = (line.y1 + 0.5) * grid.rows / size.height;
    cells.x2 = (line.x2 + 0.5) * grid.columns / size.width;
    cells.y2 = (line.y2 + 0.5) * grid.rows / size.height;
    const double bottom = grid.rows;
    const std::optional<LineSegment> inside =
        clipToRectangle(cells, {0, 0, static_cast<double>(grid.columns), bottom});
    if (!inside) {
      continue;
    }
    const auto [left, right] = std::minmax(inside->x1, inside->x2);
    const int first = firstCell(left, grid.columns);
    const int last = lastCell(right, grid.columns);
    for (int column = first; column <= last; ++column) {
      // Most lines lie within one column.
      const std::optional<LineSegment> part =
          first == last
              ? inside
              : clipToRectangle(*inside, {static_cast<double>(column), 0, column + 1.0, bottom});
      if (!part) {
        continue;
      }
      const auto [top, low] = std::minmax(part->y1, part->y2);
      for (int cell = firstCell(top, grid.rows); cell <= lastCell(low, grid.rows); ++cell) {
        touched[static_cast<std::size_t>(cell) * grid.columns + column] = true;
      }
    }
  }
  return static_cast<std::size_t>(std::count(touched.begin(), touched.end(), true));
}

SpatialSpread::SpatialSpread(SpreadGrid grid) : grid_(grid) { checkGrid(grid); }

double SpatialSpread::addFrame(const std::string& frame_name, ImageSize size,
                               const LineSegments& lines) {
  const std::size_t touched = touchedCells(frame_name, size, lines, grid_);
  touched_ += touched;
  ++frames_;
  return static_cast<double>(touched) / (static_cast<double>(grid_.columns) * grid_.rows);
}

double SpatialSpread::share() const {
  return frames_ == 0 ? 0.0
                      : static_cast<double>(touched_) / (static_cast<double>(grid_.columns) *
                                                         grid_.rows * static_cast<double>(frames_));
}

void SpatialSpread::merge(const SpatialSpread& other) {
  if (grid_.columns != other.grid_.columns || grid_.rows != other.grid_.rows) {
    throw Error("cannot merge spatial spreads: the grids differ");
  }
  touched_ += other.touched_;
  frames_ += other.frames_;
}

void SpatialSpread::reset() { *this = SpatialSpread(grid_); }

}  // namespace evolin
