// Why a figure has no value, in a sentence each.
#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/report.h"

namespace evolin {

namespace {

/// Why no frame has both depth and a pose; "" when the parts were there.
std::string whyNoDepthAndPose(const RepeatabilityReport& report) {
  if (!report.depth) {
    return "not evaluated: no depth images were received";
  }
  if (!report.camera) {
    return "not evaluated: no usable camera_info was received";
  }
  if (!report.poses) {
    return "not evaluated: no camera poses were received";
  }
  return {};
}

/// What a larger tolerance would have found.
std::string nearestMiss(const RepeatabilityReport& report) {
  return report.nearest_depth_miss
             ? " (the nearest " + formatDouble(toSeconds(*report.nearest_depth_miss)) +
                   " s away: see max_time_difference)"
             : "";
}

}  // namespace

std::string whyNoAssociation(const Report& report) {
  if (report.pairs.evaluated > 0) {
    return {};
  }
  const PairCounts& pairs = report.pairs;
  if (pairs.detected_lines + pairs.no_ground_truth + pairs.bad_ground_truth + pairs.without_ids +
          pairs.skipped ==
      0) {
    return "not evaluated: no matches were received";
  }
  if (report.pairs.detected_lines > 0) {
    return "not evaluated: detected lines";
  }
  if (report.pairs.without_ids > 0) {
    return "not evaluated: the ground truth has no ids, its true matches are unknown";
  }
  if (report.pairs.skipped + report.pairs.bad_ground_truth > 0) {
    return "not evaluated: no usable pair, see the notes";
  }
  return "not evaluated: no ground truth for the matched frames";
}

std::string whyNoAveragePrecision(const Report& report, const DetectionEntry& entry) {
  if (entry.average_precision) {
    return {};
  }
  if (report.detection_frames == 0) {
    return "no frame was evaluated";
  }
  if (entry.counts.predicted == 0) {
    return report.detection_dropped == 0
               ? "no lines were detected"
               : "the protocol drops all " + std::to_string(report.detection_dropped) +
                     " detected lines (see docs/METRICS.md)";
  }
  return report.scored ? "no lines are annotated" : "the lines carry no scores";
}

std::string whyNoDetectedAssociation(const Report& report) {
  const DetectedPairCounts& pairs = report.detected_pairs;
  if (pairs.evaluated > 0) {
    return {};
  }
  if (report.pairs.detected_lines == 0) {
    return "not evaluated: no matches between detected lines were received";
  }
  if (pairs.without_ids > 0) {
    return "not evaluated: the ground truth has no ids, its true matches are unknown";
  }
  if (pairs.skipped > 0) {
    return "not evaluated: no usable pair, see the notes";
  }
  return "not evaluated: no ground truth for the matched frames";
}

std::string whyNoHeatmap(const Report& report) {
  if (report.heatmap.lacksScores()) {
    return "not evaluated by score: the lines carry no scores";
  }
  if (report.heatmap.frames > 0) {
    return {};
  }
  if (report.heatmap.pending > 0) {
    return "not evaluated yet: frames are being measured";
  }
  return report.coverage.heatmap_skipped > 0 ? "not evaluated: all frames were skipped"
                                             : "no frame was evaluated";
}

std::string whyNoRepeatability(const Report& report, const RepeatabilityRow& row) {
  if (row.figures) {
    return {};
  }
  const std::string missing = whyNoDepthAndPose(report.repeatability);
  if (!missing.empty()) {
    return missing;
  }
  const MotionCounts& counts = report.repeatability.counts;
  if (counts.frames == 0) {
    return "not evaluated: no frame had lines, depth and a pose (" +
           std::to_string(counts.no_depth) + " without depth" + nearestMiss(report.repeatability) +
           ", " + std::to_string(counts.no_pose) + " without a pose, " +
           std::to_string(counts.bad_lines) + " with lines that are not finite)";
  }
  if (row.setting.score_threshold && counts.unscored_pairs > 0) {
    return "not evaluated: the lines carry no scores";
  }
  return "not evaluated: no two frames " + std::to_string(row.setting.frame_step) +
         " apart both had lines, depth and a pose";
}

std::string whyNoPose(const Report& report) {
  if (report.pose.errors.pairs() > 0) {
    return {};
  }
  if (report.pose.pending > 0) {
    return "not evaluated yet: pairs are being estimated";
  }
  const std::string missing = whyNoDepthAndPose(report.repeatability);
  if (!missing.empty()) {
    return missing;
  }
  const MotionCounts& counts = report.repeatability.counts;
  if (counts.pairs_no_depth + counts.pairs_no_pose + counts.pairs_no_lines +
          counts.pairs_bad_lines + counts.pairs_left_buffer + counts.pairs_skipped ==
      0) {
    return report.coverage.pose_skipped > 0 ? "not evaluated: all pairs were skipped"
                                            : "not evaluated: no matches were received";
  }
  return "not evaluated: no matched pair of frames had depth and poses (" +
         std::to_string(counts.pairs_no_depth) + " without depth" +
         nearestMiss(report.repeatability) + ", " + std::to_string(counts.pairs_no_pose) +
         " without a pose, " + std::to_string(counts.pairs_no_lines) + " without lines, " +
         std::to_string(counts.pairs_bad_lines) + " with lines that are not finite, " +
         std::to_string(counts.pairs_left_buffer) + " of frames that had left the buffer, " +
         std::to_string(counts.pairs_skipped) + " unusable)";
}

}  // namespace evolin
