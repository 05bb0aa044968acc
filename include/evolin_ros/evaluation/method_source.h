// The name under which the lines or matches of a method go, with a tag that changes with every
// setting that changes them.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "evolin_ros/geometry/line_selection.h"

namespace evolin {

/// `name` and a settingsTag() of the plug-in's parameters, of the selection among its lines, and of
/// `more`; without a tag where all of them are the defaults. The same settings give the same name
/// in a nodelet and on the command line.
std::string methodSource(const std::string& name, const YAML::Node& parameters,
                         const LineSelection& selection = {},
                         const YAML::Node& more = YAML::Node(YAML::NodeType::Map));

}  // namespace evolin
