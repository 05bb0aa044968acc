// One frame's own figures as a pass keeps them for its report: as small as they can be, as there
// are as many as frames.
#pragma once

#include <cstdint>
#include <vector>

#include "evolin_ros/evaluation/report.h"

namespace evolin {

/// 16 bytes a setting of detection, 8 a setting of the heatmap, and no more than 64 besides.
class FrameFigures {
 public:
  /// Takes what it keeps out of `record`, whose entries are empty then.
  void keepDetection(FrameRecord* record);
  void keepHeatmap(const std::vector<Classification>& counts);

  /// Fills in entries and heatmap; `settings` are those of the entries that were kept.
  void restore(const std::vector<VectorizedSetting>& settings, FrameRecord* record) const;

 private:
  struct Detection {
    double average_precision;  ///< NaN: none
    std::uint32_t true_positives;
    std::uint32_t predicted;
  };
  struct Pixels {
    std::uint32_t true_positives;
    std::uint32_t predicted;
  };

  std::vector<Detection> detection_;  ///< by setting
  std::vector<Pixels> heatmap_;       ///< by setting
  std::uint32_t ground_truth_ = 0;    ///< lines
  std::uint32_t ground_truth_pixels_ = 0;
};

}  // namespace evolin
