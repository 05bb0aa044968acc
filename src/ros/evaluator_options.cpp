// Ranges and names of the evaluator's parameters that are not the evaluation's own.
#include "evaluator_options.h"

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/evaluation/evaluation_settings.h"

namespace evolin::ros_shell {

EvaluatorOptions readEvaluatorOptions(const YAML::Node& parameters, const std::string& owner) {
  constexpr double kLongest = 1e6;
  constexpr double kHeatmapBudget = 1;
  EvaluatorOptions options;
  std::string pose_from = "topic";
  ParameterReader reader(parameters, owner);
  const EvaluationSettings settings = readEvaluationSettings(&reader, owner, kHeatmapBudget);
  options.pass = settings.pass;
  options.bootstrap = settings.bootstrap;
  reader.read("task_queue", &options.task_queue, 1, 1000000);
  reader.read("depth_factor", &options.depth_factor, 1e-6, 1e9);
  reader.read("pose_from", &pose_from, {"topic", "tf"});
  reader.read("world_frame", &options.world_frame);
  reader.read("output_dir", &options.output_dir);
  reader.read("save_period", &options.save_period, 0.01, kLongest);
  reader.read("idle_timeout", &options.idle_timeout, 0, kLongest);
  reader.read("drain_timeout", &options.drain_timeout, 0, kLongest);
  reader.read("warn_after", &options.warn_after, 0, kLongest);
  reader.read("record_parameters", &options.record_parameters);
  options.health = readHealthLimits(&reader, owner);
  // Set by the player: name, size and hash of the bag, for the report's provenance.
  reader.readMap("input");
  reader.finish();
  options.pose_from =
      pose_from == "tf" ? EvaluatorOptions::PoseFrom::kTf : EvaluatorOptions::PoseFrom::kTopic;
  return options;
}

}  // namespace evolin::ros_shell
