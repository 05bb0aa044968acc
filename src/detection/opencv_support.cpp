// What the detectors made of OpenCV's functions share.
#include "opencv_support.h"

namespace evolin {
namespace {

template <typename Row>
LineSegments convert(const std::vector<Row>& rows) {
  LineSegments lines;
  lines.reserve(rows.size());
  for (const Row& row : rows) {
    LineSegment line;
    line.x1 = row[0];
    line.y1 = row[1];
    line.x2 = row[2];
    line.y2 = row[3];
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

void requireOddAperture(const std::string& owner, int canny_aperture) {
  if (canny_aperture != 3 && canny_aperture != 5 && canny_aperture != 7) {
    throw ConfigError(owner, "canny_aperture",
                      std::to_string(canny_aperture) + " is not one of 3, 5, 7");
  }
}

LineSegments toLineSegments(const std::vector<cv::Vec4f>& rows) { return convert(rows); }

LineSegments toLineSegments(const std::vector<cv::Vec4i>& rows) { return convert(rows); }

}  // namespace evolin
