// Reading and applying the selection of lines that all our own detectors offer.
#include "evolin_ros/detection/detector_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/image_file.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {
namespace {

std::string text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// Lines may be fitted a little beyond the outermost pixels.
void clipToImage(cv::Size size, LineSegments* lines) {
  const Rectangle image{-0.5, -0.5, size.width - 0.5, size.height - 0.5};
  std::size_t kept = 0;
  for (const LineSegment& line : *lines) {
    const std::optional<LineSegment> inside = clipToRectangle(line, image);
    if (inside && inside->length() > 0) {
      (*lines)[kept++] = *inside;
    }
  }
  lines->resize(kept);
}

}  // namespace

void readSelection(ParameterReader* reader, DetectorSelection* selection) {
  constexpr double kUnlimited = -LineSelection::kNoScoreThreshold;
  reader->read("score_threshold", &selection->score_threshold, -kUnlimited, kUnlimited);
  reader->read("min_length", &selection->min_length, 0.0, 100000.0);
  reader->read("max_lines", &selection->max_lines, 0, 1000000);
  reader->read("mask", &selection->mask);
}

LineFilter::LineFilter(const DetectorSelection& selection) : mask_file_(selection.mask) {
  selection_.score_threshold = selection.score_threshold;
  selection_.min_length = selection.min_length;
  selection_.max_lines = static_cast<std::size_t>(selection.max_lines);
  if (!mask_file_.empty()) {
    mask_ = toGray(readImage(mask_file_));
  }
}

LineSegments LineFilter::apply(LineSegments lines, cv::Size size, const std::string& owner) const {
  clipToImage(size, &lines);
  return applyUncut(std::move(lines), size, owner);
}

LineSegments LineFilter::applyUncut(LineSegments lines, cv::Size size,
                                    const std::string& owner) const {
  if (!mask_.empty()) {
    if (mask_.size() != size) {
      throw Error(owner + ": the mask " + mask_file_ + " has " + text(mask_.size()) +
                  " pixels; expected " + text(size) + ", the size of the image");
    }
    const auto nearest = [](double middle, int end) {
      return static_cast<int>(std::lround(std::clamp(middle, 0.0, end - 1.0)));
    };
    lines.erase(std::remove_if(lines.begin(), lines.end(),
                               [&](const LineSegment& line) {
                                 const int x = nearest((line.x1 + line.x2) / 2, mask_.cols);
                                 const int y = nearest((line.y1 + line.y2) / 2, mask_.rows);
                                 return mask_.at<std::uint8_t>(y, x) == 0;
                               }),
                lines.end());
  }
  return selectLines(std::move(lines), selection_);
}

}  // namespace evolin
