// The picture of one evaluated frame: what was found, what is false, what was missed, where matched
// lines come from, and the figures so far in a margin.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evolin_ros/drawing/line_trails.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/line_verdicts.h"

namespace evolin {

struct ViewOptions {
  double scale = 1;            ///< picture pixels to an image pixel; for displays of high density
  bool margin = true;          ///< legend and figures beside the image
  double brightness = 0.6;     ///< of the image below the lines, 0: black, 1: as it is
  double line_width = 1.25;    ///< image pixels
  bool true_positives = true;  ///< which lines are drawn; all are counted in the legend
  bool false_positives = true;
  bool misses = true;
  bool dropped = true;
  bool trails = true;
};

/// Throws Error naming the option, its value and the accepted range.
void validate(const ViewOptions& options);

struct ViewRow {
  std::string name;
  std::string value;
};

struct ViewSection {
  std::string title;
  std::vector<ViewRow> rows;
};

struct EvaluatedFrame {
  cv::Mat image;              ///< CV_8UC1 or CV_8UC3
  LineSegments lines;         ///< detected
  LineSegments ground_truth;  ///< empty without verdicts
  LineVerdicts verdicts;      ///< of `lines` and `ground_truth`; empty when nobody judged them
  std::string no_verdicts;    ///< why, for the legend; "" when they are there
  std::vector<LineTrail> trails;
  std::string title;
  std::string judged_by;  ///< the distance and threshold behind the verdicts, for the legend
  std::vector<ViewSection> sections;
};

/// Width of the margin in image pixels.
constexpr int kViewMargin = 250;

/// Size of the picture that drawEvaluatedFrame() makes: the image, with the margin to its right,
/// times the scale; higher than the image where the margin's text needs it.
cv::Size viewSize(const EvaluatedFrame& frame, const ViewOptions& options);

/// CV_8UC3 (BGR). Throws Error for an image of another type or without pixels, verdicts of another
/// number of lines, and options as validate().
cv::Mat drawEvaluatedFrame(const EvaluatedFrame& frame, const ViewOptions& options);

}  // namespace evolin
