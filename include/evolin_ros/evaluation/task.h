// Work of an evaluation that is too heavy to be done where messages arrive: self-contained, to be
// done on any thread, its result handed back.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "evolin_ros/evaluation/pose_task.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/classification.h"
#include "evolin_ros/metrics/heatmap.h"

namespace evolin {

/// Detection scored on pixels, of one frame.
struct HeatmapTask {
  Stamp stamp = 0;
  ImageSize size;
  LineSegments lines;
  LineSegments ground_truth;
};

struct HeatmapRecord {
  Stamp stamp = 0;
  std::vector<Classification> counts;  ///< by falling score threshold; one without thresholds
  /// False: a line has no score although there are thresholds; `counts` is one, of all lines. None:
  /// there are no lines, `counts` stand for either.
  std::optional<bool> scored = true;
  std::string reason;  ///< why there are none; "" when there are
};

struct EvaluationTask {
  std::uint64_t generation = 0;  ///< of the evaluator that gave it out; a reset starts the next
  int pass = 0;
  std::variant<HeatmapTask, PoseTask> work;
};

struct EvaluationResult {
  std::uint64_t generation = 0;
  int pass = 0;
  std::variant<HeatmapRecord, PoseRecord> record;
};

struct TaskOptions {
  HeatmapOptions heatmap;
  PoseMethodOptions pose_method;
};

/// Safe for several threads.
class TaskRunner {
 public:
  /// A heatmap is broken off, with that for its reason, once `stop` is true; it outlives the
  /// runner. Pose estimates take milliseconds and end by themselves. None: nothing stops a task.
  explicit TaskRunner(const TaskOptions& options, const std::atomic<bool>* stop = nullptr);

  EvaluationResult run(const EvaluationTask& task) const;

 private:
  HeatmapRecord measure(const HeatmapTask& task) const;
  PoseRecord estimate(const PoseTask& task) const;

  HeatmapOptions heatmap_;
  PoseMethod pose_method_;
};

}  // namespace evolin
