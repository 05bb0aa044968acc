// Ranges and names of the evaluator's parameters.
#include "evaluator_options.h"

#include <limits>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin::ros_shell {

EvaluatorOptions readEvaluatorOptions(const YAML::Node& parameters, const std::string& owner) {
  constexpr double kLongest = 1e6;
  EvaluatorOptions options;
  VectorizedOptions& vectorized = options.pass.evaluation.vectorized;
  std::string protocol = toString(vectorized.protocol);
  int buffer = static_cast<int>(options.pass.buffer);
  ParameterReader reader(parameters, owner);
  reader.read("protocol", &protocol, {"evolin", "paper"});
  reader.read("distance_thresholds", &vectorized.distance_thresholds,
              std::numeric_limits<double>::min(), 1e9);
  reader.read("frame_step", &options.pass.frame_step, 1, 100000);
  reader.read("buffer", &buffer, 2, 1000000);
  reader.read("output_dir", &options.output_dir);
  reader.read("save_period", &options.save_period, 0.01, kLongest);
  reader.read("idle_timeout", &options.idle_timeout, 0, kLongest);
  reader.read("drain_timeout", &options.drain_timeout, 0, kLongest);
  reader.read("warn_after", &options.warn_after, 0, kLongest);
  reader.read("record_parameters", &options.record_parameters);
  // Set by the player: name, size and hash of the bag, for the report's provenance.
  reader.readMap("input");
  reader.finish();
  vectorized.protocol = parseProtocol(protocol);
  options.pass.buffer = static_cast<std::size_t>(buffer);
  const std::size_t most = VectorizedMetrics::kMaxSettings / vectorized.distances.size();
  if (vectorized.distance_thresholds.size() > most) {
    throw ConfigError(owner, "distance_thresholds",
                      "expected at most " + std::to_string(most) + " numbers, got " +
                          std::to_string(vectorized.distance_thresholds.size()));
  }
  return options;
}

}  // namespace evolin::ros_shell
