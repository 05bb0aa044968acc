// The a-contrario validation of EDLines: which lines are too good for an image of noise.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "edlines_fit.h"
#include "log_factorials.h"

namespace evolin::edlines {

/// Keeps the least numbers of aligned pixels for one size of image at a time.
class Validation {
 public:
  /// `gray` (CV_8UC1) must outlive the calls that follow.
  void start(const cv::Mat& gray);

  /// Do so many pixels within a pixel of the line's segment have its direction that less than one
  /// line in an image of noise would?
  bool isMeaningful(const FittedLine& line);

 private:
  void count(const FittedLine& line);
  bool isAligned(int x, int y) const;
  int leastAligned(int pixels);

  const cv::Mat* gray_ = nullptr;
  double log_tests_ = 0;  // of the number of lines that an image may have

  // Of the line that is being validated.
  double direction_x_ = 0;
  double direction_y_ = 0;
  double degrees_ = 0;
  int pixels_ = 0;
  int aligned_ = 0;

  std::vector<int> least_;  // by number of pixels
  LogFactorials log_factorial_;
};

}  // namespace evolin::edlines
