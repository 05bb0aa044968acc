// Ranges and names of the viewer's parameters.
#include "viewer_options.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "evolin_ros/base/parameters.h"

namespace evolin::ros_shell {

ViewerOptions readViewerOptions(const YAML::Node& parameters, const std::string& owner) {
  ViewerOptions options;
  ViewOptions& view = options.view;
  const std::vector<std::pair<std::string, bool*>> layers = {
      {"true_positives", &view.true_positives},
      {"false_positives", &view.false_positives},
      {"misses", &view.misses},
      {"not_scored", &view.dropped},
      {"trails", &view.trails}};
  std::vector<std::string> names;
  for (const auto& layer : layers) {
    names.push_back(layer.first);
  }
  std::vector<std::string> shown = names;
  std::string protocol = toString(options.frame.protocol);
  std::string trails_from = "matches";
  ParameterReader reader(parameters, owner);
  reader.read("threshold", &options.frame.threshold, 1e-6, 1e6);
  reader.read("protocol", &protocol, {"evolin", "paper"});
  reader.read("layers", &shown, names);
  reader.read("trails_from", &trails_from, {"matches", "ids", "none"});
  reader.read("trail_length", &options.frame.trail_length, 2, 1000);
  reader.read("scale", &view.scale, 0.25, 8);
  reader.read("margin", &view.margin);
  reader.read("brightness", &view.brightness, 0, 1);
  reader.read("line_width", &view.line_width, 0.25, 20);
  reader.read("plane_distance", &options.plane_distance, 1e-3, 1e3);
  reader.read("queue_size", &options.queue_size, 1, 100000);
  reader.read("patience", &options.patience, 0, 1000);
  reader.read("image_transport", &options.image_transport);
  reader.read("warn_after", &options.warn_after, 0, 1e6);
  options.health = readHealthLimits(&reader, owner);
  reader.finish();
  options.frame.protocol = parseProtocol(protocol);
  options.frame.trails_from = trails_from == "matches" ? TrailsFrom::kMatches
                              : trails_from == "ids"   ? TrailsFrom::kIds
                                                       : TrailsFrom::kNone;
  for (const auto& [name, layer] : layers) {
    *layer = std::find(shown.begin(), shown.end(), name) != shown.end();
  }
  return options;
}

}  // namespace evolin::ros_shell
