// Names of stages, as report.json has them.
#include "evolin_ros/evaluation/stage_times.h"

namespace evolin {

std::string toString(Stage stage) {
  switch (stage) {
    case Stage::kDecode:
      return "decode";
    case Stage::kDetect:
      return "detect";
    case Stage::kDescribe:
      return "describe";
    case Stage::kMatch:
      return "match";
    case Stage::kDetection:
      return "detection";
    case Stage::kHeatmap:
      return "heatmap";
    case Stage::kRepeatability:
      return "repeatability";
    case Stage::kAssociation:
      return "association";
    case Stage::kPose:
      return "pose";
    case Stage::kTracks:
      return "tracks";
    case Stage::kReport:
      return "report";
    case Stage::kCount:
      break;
  }
  return "none";
}

}  // namespace evolin
