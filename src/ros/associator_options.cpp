// Names and ranges of the associator's parameters.
#include "associator_options.h"

#include "changed_names.h"
#include "evolin_ros/evaluation/method_source.h"
#include "node_parameters.h"
#include "topics.h"

namespace evolin::ros_shell {

AssociatorOptions readAssociatorOptions(const YAML::Node& parameters, const std::string& owner) {
  AssociatorOptions options;
  options.queue_size = kImageQueue;
  std::string rectify = "false";
  ParameterReader reader(parameters, owner);
  reader.read("associator", &options.associator);
  reader.read("config", &options.config);
  reader.read("source", &options.source);
  reader.read("camera", &options.camera);
  reader.read("rectify", &rectify, {"false", "true", "refuse"});
  reader.read("frame_step", &options.frame_step, 1, 100000);
  reader.read("image_transport", &options.image_transport);
  reader.read("queue_size", &options.queue_size, 1, 100000);
  reader.read("realtime", &options.realtime);
  reader.read("lazy", &options.lazy);
  reader.read("warn_after", &options.warn_after, 0, 1e6);
  options.health = readHealthLimits(&reader, owner);
  const YAML::Node overrides = reader.readMap("parameters");
  reader.finish();
  options.rectify = parseRectify(rectify);
  options.parameters = mergedParameters(options.config, overrides);
  return options;
}

std::string AssociatorOptions::taggedSource() const {
  YAML::Node more(YAML::NodeType::Map);
  if (!source.empty() && !named_associator.empty() && associator != named_associator) {
    more["associator"] = associator;
  }
  if (rectify == Rectify::kAlways) {
    more["rectify"] = "true";
    more["camera"] = camera;
  }
  return methodSource(name(), parameters, LineSelection(), more);
}

std::string AssociatorOptions::needsRestart(const AssociatorOptions& now) const {
  return changedNames({{"frame_step", frame_step != now.frame_step},
                       {"image_transport", image_transport != now.image_transport},
                       {"queue_size", queue_size != now.queue_size},
                       {"realtime", realtime != now.realtime},
                       {"lazy", lazy != now.lazy},
                       {"warn_after", warn_after != now.warn_after}});
}

}  // namespace evolin::ros_shell
