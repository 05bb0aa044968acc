// Plays back the lines that any method has written to a folder.
#pragma once

#include <optional>

#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/dataset/times_file.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// Plug-in `recorded`. Parameters: `folder`, in the layout of AnnotationFolder ('evolin detect'
/// writes such), and `stamps`, a stamps file where the folder has none; relative paths are taken
/// from the working directory. A frame gets the lines of its stamp within 0.001 s; detect() throws
/// Error for one without an entry. A times.txt beside the stamps gives the time that the method
/// itself took.
class RecordedDetector : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return folder_ && folder_->hasScores(); }
  LineSegments detect(const Frame& frame) override;
  std::optional<double> processingTime() const override { return processing_time_; }

 private:
  std::optional<AnnotationFolder> folder_;
  ProcessingTimes times_;
  std::optional<double> processing_time_;  ///< of the last frame
};

}  // namespace evolin
