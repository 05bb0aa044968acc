// The evaluator nodelet's parameters.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "health.h"

namespace evolin::ros_shell {

struct EvaluatorOptions {
  PassOptions pass;
  /// Where ground-truth poses come from.
  enum class PoseFrom { kTopic, kTf };
  PoseFrom pose_from = PoseFrom::kTopic;
  std::string world_frame = "world";  ///< of tf, with or without a leading slash
  double depth_factor = 1000;  ///< stored units per metre of 16-bit depth images; TUM's files: 5000
  int task_queue = 1000;       ///< heatmaps and pose estimates that may wait for their turn
  BootstrapOptions bootstrap;  ///< of the reports of ~finish and ~save_report; 0 resamples: none
  std::string output_dir;      ///< "": a new folder under ~/.ros/evolin_ros
  double save_period = 5;      ///< s of wall time between two savings
  double idle_timeout = 2;     ///< s of wall time without input after which the report is saved
  double drain_timeout =
      5;  ///< s of wall time without input after which ~finish stops waiting for what is due
  double warn_after = 3;  ///< s without an expected message until the warning; 0: never
  HealthLimits health;
  std::vector<std::string>
      record_parameters;  ///< namespaces whose parameters the report shall carry
};

/// Throws ConfigError naming the parameter, its value and what is accepted.
EvaluatorOptions readEvaluatorOptions(const YAML::Node& parameters, const std::string& owner);

}  // namespace evolin::ros_shell
