// A short name for a set of parameters, by which results of different settings are told apart.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace evolin {

/// "" for an empty or null map, else '#' and eight hexadecimal digits that depend on the map's
/// content alone: not on the order of its keys, nor on how numbers and text are quoted. Equal
/// settings written differently (5 and 5.0) get different tags, which is safe; different ones that
/// share a tag are as likely as two equal 32-bit numbers.
std::string settingsTag(const YAML::Node& settings);

}  // namespace evolin
