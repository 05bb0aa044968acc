// A node's private parameters as YAML, so that they are checked by the same reader as a plug-in's
// files.
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

#include "evolin_ros/geometry/camera.h"

namespace evolin::ros_shell {

/// Scalars, lists and maps; throws Error for binary and date values.
YAML::Node toYaml(XmlRpc::XmlRpcValue value);

/// Everything below the handle's namespace as a map; null when there is nothing.
YAML::Node privateParameters(const ros::NodeHandle& handle);

/// Types as they are; what JSON cannot hold (NaN, infinities, binary data) as text, bytes that are
/// not UTF-8 replaced. Never throws for a value.
std::string toJsonText(const XmlRpc::XmlRpcValue& value);

/// Everything below `name` as JSON text, "null" when there is nothing.
std::string parametersAsJson(const std::string& name);

/// A plug-in's parameters: the map of the file `config` (when not "") with `overrides` laid over
/// it. Throws Error naming the file when it cannot be read or is not a map.
YAML::Node mergedParameters(const std::string& config, const YAML::Node& overrides);

/// `path` with ~ for the home folder and relative paths taken from where the launch was called.
std::string expandPath(const std::string& path);

/// The camera that ~camera names: a preset, with or without its .yaml, or else a file as
/// expandPath() finds it. `presets` is the presets' folder. Throws Error naming the presets, or
/// both places where a file was looked for.
Camera cameraOfParameter(const std::string& name_or_file, const std::filesystem::path& presets);

}  // namespace evolin::ros_shell
