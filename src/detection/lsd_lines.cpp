// From seeds to lines.
#include "lsd_lines.h"

#include <cmath>

namespace evolin::lsd {

const LineSegments& LineFinder::find(const cv::Mat& gray) {
  found_.clear();
  builder_.build(gray, &field_);
  if (field_.size() == 0) {
    return found_;
  }
  const double tolerance = parameters_.angle_tolerance * CV_PI / 180;
  const double chance = parameters_.angle_tolerance / 180;
  const bool standard = parameters_.refine != "none";
  const bool advanced = parameters_.refine == "advanced";
  grower_.start(field_);
  validation_.start(field_);
  // Smaller regions cannot be meaningful, however well they are aligned.
  const auto fewest = static_cast<std::size_t>(-validation_.logTests() / std::log10(chance));
  for (const std::int32_t seed : field_.seeds) {
    if (!grower_.isFree(seed)) {
      continue;
    }
    grower_.grow(seed, tolerance);
    if (grower_.size() < fewest) {
      continue;
    }
    Rectangle rectangle = grower_.fit(tolerance, chance);
    if (standard && !grower_.refine(parameters_.density_threshold, &rectangle)) {
      continue;
    }
    double score = kNoScore;
    if (advanced) {
      score = validation_.improve(parameters_.log_eps, &rectangle);
      if (!(score > parameters_.log_eps)) {
        continue;
      }
    }
    // A level line runs through the corner between four pixels.
    const auto place = [&](double coordinate) { return (coordinate + 0.5) / parameters_.scale; };
    LineSegment line;
    line.x1 = place(rectangle.x1);
    line.y1 = place(rectangle.y1);
    line.x2 = place(rectangle.x2);
    line.y2 = place(rectangle.y2);
    line.score = score;
    found_.push_back(line);
  }
  return found_;
}

}  // namespace evolin::lsd
