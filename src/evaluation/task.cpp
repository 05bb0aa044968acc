// One accumulator a frame: only its counts go back.
#include "evolin_ros/evaluation/task.h"

#include <algorithm>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

TaskRunner::TaskRunner(const TaskOptions& options, const std::atomic<bool>* stop)
    : heatmap_(options.heatmap), pose_method_(options.pose_method) {
  heatmap_.stop = stop;
}

EvaluationResult TaskRunner::run(const EvaluationTask& task) const {
  EvaluationResult result{task.generation, task.pass, HeatmapRecord()};
  if (const auto* heatmap = std::get_if<HeatmapTask>(&task.work)) {
    result.record = measure(*heatmap);
  } else {
    result.record = estimate(std::get<PoseTask>(task.work));
  }
  return result;
}

/// Whatever a solver throws ends here: the thread that runs tasks has nobody to catch it.
PoseRecord TaskRunner::estimate(const PoseTask& task) const {
  try {
    return runPoseTask(task, pose_method_);
  } catch (const std::exception& error) {
    PoseRecord record;
    record.first_stamp = task.first_stamp;
    record.stamp = task.stamp;
    record.matched = task.matched;
    record.with_depth = task.matches.size();
    record.truth = task.truth;
    record.pair.moved = task.truth.translation.norm();
    record.reason = error.what();
    return record;
  }
}

HeatmapRecord TaskRunner::measure(const HeatmapTask& task) const {
  HeatmapRecord record;
  record.stamp = task.stamp;
  HeatmapOptions options = heatmap_;
  const bool unscored = std::any_of(task.lines.begin(), task.lines.end(),
                                    [](const LineSegment& line) { return !line.hasScore(); });
  if (task.lines.empty()) {
    record.scored.reset();
  } else if (unscored && !options.score_thresholds.empty()) {
    record.scored = false;
    options.score_thresholds.clear();
  }
  HeatmapMetrics frame(options);
  try {
    const HeatmapOutcome outcome =
        frame.addFrame(0, formatStamp(task.stamp), task.size, task.lines, task.ground_truth);
    switch (outcome) {
      case HeatmapOutcome::kAdded:
        record.counts = frame.classifications();
        break;
      case HeatmapOutcome::kOverBudget:
        record.reason = "frame " + formatStamp(task.stamp) + " takes longer than the " +
                        formatDouble(heatmap_.frame_budget) + " s that a frame may take";
        break;
      case HeatmapOutcome::kStopped:
        record.reason = "frame " + formatStamp(task.stamp) + " was still being measured at the end";
        break;
    }
  } catch (const std::exception& error) {
    record.reason = error.what();
  }
  return record;
}

}  // namespace evolin
