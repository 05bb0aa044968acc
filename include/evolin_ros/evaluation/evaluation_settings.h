// What an evaluation can be told, by name: the same words for the evaluator's parameters and for
// the command line.
#pragma once

#include <string>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/evaluation/pass_evaluation.h"
#include "evolin_ros/metrics/bootstrap.h"

namespace evolin {

struct EvaluationSettings {
  PassOptions pass;
  BootstrapOptions bootstrap;  ///< 0 resamples: no intervals
};

/// Reads the keys of an evaluation (`metrics`, `protocol`, `distance_thresholds`, ...) and leaves
/// others to the caller, who calls finish() on the reader. `heatmap_budget` is the default of that
/// key, seconds a frame; 0: unlimited. Throws ConfigError naming the key, its value and what is
/// accepted.
EvaluationSettings readEvaluationSettings(ParameterReader* reader, const std::string& owner,
                                          double heatmap_budget);

}  // namespace evolin
