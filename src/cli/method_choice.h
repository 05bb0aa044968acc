// "NAME:key=value,..." on the command line: a plug-in with its parameters.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <memory>
#include <string>

#include "evolin_ros/dataset/needs.h"
#include "plugin_loader.h"

namespace evolin::cli {

struct MethodChoice {
  std::string name;
  YAML::Node parameters = YAML::Node(YAML::NodeType::Map);
};

/// `text` is NAME, or NAME:key=value,key=value; a list is [1, 2]. `config` is a YAML file of
/// parameters that those of `text` go over; "": none. Throws UsageError naming `option` for another
/// form, ParseError for the file.
MethodChoice parseMethod(const std::string& option, const std::string& text,
                         const std::string& config);

/// Sets `key=value` pairs, separated by commas outside brackets, in `parameters`. Throws UsageError
/// naming `option`.
void parseAssignments(const std::string& option, const std::string& text, YAML::Node* parameters);

/// Makers of configured instances; `loader` outlives them. The first instance is made at once, so
/// that a wrong name or parameter is told before anything is read, and is the first given out; what
/// it needs, which may depend on its parameters, is added to `needs`. Throw as PluginLoader and
/// configure(); where this build lacks the method the message names those that run.
std::function<std::shared_ptr<LineDetector>()> detectorMaker(PluginLoader* loader,
                                                             const MethodChoice& choice,
                                                             Needs* needs);
std::function<std::shared_ptr<LineAssociator>()> associatorMaker(PluginLoader* loader,
                                                                 const MethodChoice& choice,
                                                                 Needs* needs);

}  // namespace evolin::cli
