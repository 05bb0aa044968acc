// Plays back the lines that any method has written to a folder.
#pragma once

#include <optional>

#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// Plug-in `recorded`. Parameters: `folder`, in the layout of AnnotationFolder ('evolin detect'
/// writes such), and `stamps`, a stamps file where the folder has none; relative paths are taken
/// from the working directory. A frame gets the lines of its stamp within 0.001 s; detect() throws
/// Error for one without an entry.
class RecordedDetector : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return folder_ && folder_->hasScores(); }
  LineSegments detect(const Frame& frame) override;

 private:
  std::optional<AnnotationFolder> folder_;
};

}  // namespace evolin
