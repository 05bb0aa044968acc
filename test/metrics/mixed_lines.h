// Lines of every kind, for the searches among many lines.
#pragma once

#include <cstddef>

#include "test/metrics/vectorized_support.h"
#include "test/support/random_lines.h"

namespace evolin::test {

/// Short and long lines, points, copies, and lines with one midpoint.
inline LineSegments mixedLines(std::size_t count, RandomLines* random) {
  LineSegments lines = random->anywhere(count, 160, 160);
  for (std::size_t row = 0; row < count; ++row) {
    LineSegment& line = lines[row];
    switch (row % 7) {
      case 0:  // anywhere
        break;
      case 1:
        line.x2 = line.x1;
        line.y2 = line.y1;
        break;
      case 2:
        line = lines[random->index(row)];
        break;
      case 3:
        line.x2 = 128 - line.x1;
        line.y2 = 128 - line.y1;
        break;
      default:
        line.x2 = line.x1 + random->uniform(-20, 20);
        line.y2 = line.y1 + random->uniform(-20, 20);
    }
  }
  return lines;
}

}  // namespace evolin::test
