// Scaling to the 128 x 128 frame.
#include "scaling.h"

#include "evolin_ros/base/text.h"

namespace evolin {

LineSegment scaled(const LineSegment& line, ImageSize size) {
  LineSegment result = line;
  result.x1 = line.x1 * kScaledSide / size.width;
  result.y1 = line.y1 * kScaledSide / size.height;
  result.x2 = line.x2 * kScaledSide / size.width;
  result.y2 = line.y2 * kScaledSide / size.height;
  return result;
}

LineSegments scaledLines(const SpatialFrame& frame) {
  LineSegments lines;
  lines.reserve(frame.lines.size());
  for (const SpatialLine& line : frame.lines) {
    if (line.in_image) {
      lines.push_back(scaled(line.segment, frame.size));
    }
  }
  return lines;
}

std::string coordinates(const LineSegment& line) {
  return formatDouble(line.x1) + "," + formatDouble(line.y1) + "," + formatDouble(line.x2) + "," +
         formatDouble(line.y2);
}

}  // namespace evolin
