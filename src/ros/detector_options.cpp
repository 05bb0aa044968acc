// Names and ranges of the detector's parameters.
#include "detector_options.h"

#include "changed_names.h"
#include "evolin_ros/evaluation/method_source.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

DetectorOptions readDetectorOptions(const YAML::Node& parameters, const std::string& owner) {
  DetectorOptions options;
  std::string rectify = "false";
  double score_threshold = options.selection.score_threshold;
  int max_lines = 0;
  ParameterReader reader(parameters, owner);
  reader.read("detector", &options.detector);
  reader.read("config", &options.config);
  reader.read("source", &options.source);
  reader.read("camera", &options.camera);
  reader.read("rectify", &rectify, {"false", "true", "refuse"});
  // The ranges of cfg/LineDetector.cfg.
  reader.read("score_threshold", &score_threshold, LineSelection::kNoScoreThreshold,
              -LineSelection::kNoScoreThreshold);
  reader.read("min_length", &options.selection.min_length, 0, 1e5);
  reader.read("max_lines", &max_lines, 0, 1000000);
  reader.read("line_width", &options.style.width, 1, 20);
  reader.read("draw_endpoints", &options.style.endpoints);
  reader.read("image_transport", &options.image_transport);
  reader.read("queue_size", &options.queue_size, 0, 100000);
  reader.read("realtime", &options.realtime);
  reader.read("lazy", &options.lazy);
  reader.read("warn_after", &options.warn_after, 0, 1e6);
  options.health = readHealthLimits(&reader, owner);
  const YAML::Node overrides = reader.readMap("parameters");
  reader.finish();
  options.rectify = parseRectify(rectify);
  options.selection.score_threshold = score_threshold;
  options.selection.max_lines = static_cast<std::size_t>(max_lines);
  options.parameters = mergedParameters(options.config, overrides);
  return options;
}

std::string DetectorOptions::taggedSource() const {
  YAML::Node more(YAML::NodeType::Map);
  if (!source.empty() && !named_detector.empty() && detector != named_detector) {
    more["detector"] = detector;
  }
  if (rectify == Rectify::kAlways) {
    more["rectify"] = "true";
    more["camera"] = camera;
  }
  return methodSource(name(), parameters, selection, more);
}

std::string DetectorOptions::needsRestart(const DetectorOptions& now) const {
  return changedNames({{"image_transport", image_transport != now.image_transport},
                       {"queue_size", queue_size != now.queue_size},
                       {"realtime", realtime != now.realtime},
                       {"lazy", lazy != now.lazy},
                       {"warn_after", warn_after != now.warn_after}});
}

}  // namespace evolin::ros_shell
