// Settings as one map under one tag.
#include "evolin_ros/evaluation/method_source.h"

#include "evolin_ros/base/settings_tag.h"
#include "evolin_ros/base/text.h"

namespace evolin {

std::string methodSource(const std::string& name, const YAML::Node& parameters,
                         const LineSelection& selection, const YAML::Node& more) {
  YAML::Node settings = YAML::Clone(more);
  if (parameters.size() > 0) {
    settings["parameters"] = parameters;
  }
  if (!selection.keepsAll()) {
    settings["score_threshold"] = formatDouble(selection.score_threshold);
    settings["min_length"] = formatDouble(selection.min_length);
    settings["max_lines"] = std::to_string(selection.max_lines);
  }
  return name + settingsTag(settings);
}

}  // namespace evolin
