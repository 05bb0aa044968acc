// What every detector of ours can leave out of its result by itself.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/geometry/line_selection.h"

namespace evolin {

/// The defaults keep everything.
struct DetectorSelection {
  double score_threshold = LineSelection::kNoScoreThreshold;  ///< kept: score > threshold
  double min_length = 0;  ///< pixels; kept: length >= min_length; 0 to 100000
  int max_lines = 0;      ///< the best by score, else by length; 0: all; to 1000000
  std::string mask;       ///< image file; kept: lines whose middle is on a pixel above 0; "": all
};

/// The parameters `score_threshold`, `min_length`, `max_lines` and `mask` of a plug-in.
void readSelection(ParameterReader* reader, DetectorSelection* selection);

/// Applies a DetectorSelection; holds the mask's pixels.
class LineFilter {
 public:
  LineFilter() = default;

  /// Reads the mask. Throws Error naming the file when that is no image.
  explicit LineFilter(const DetectorSelection& selection);

  /// The lines of an image of `size`, cut at the outer edges of its pixels, that pass, in their
  /// order; never one of no length. Throws Error naming `owner`, the
  /// mask's file and both sizes where the mask has another size than the image.
  LineSegments apply(LineSegments lines, cv::Size size, const std::string& owner) const;

  /// The same of lines that stay as they are: not cut, and of any length.
  LineSegments applyUncut(LineSegments lines, cv::Size size, const std::string& owner) const;

 private:
  LineSelection selection_;
  std::string mask_file_;
  cv::Mat mask_;
};

}  // namespace evolin
