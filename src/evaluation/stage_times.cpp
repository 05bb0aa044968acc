// Names of stages, as report.json has them, and the two clocks.
#include "evolin_ros/evaluation/stage_times.h"

#include <ctime>

namespace evolin {

namespace {

/// Seconds that the calling thread has run.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

StageClock::StageClock() : processor_(threadSeconds()) {}

StageTime StageClock::elapsed() const { return {wall_.seconds(), threadSeconds() - processor_}; }

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
