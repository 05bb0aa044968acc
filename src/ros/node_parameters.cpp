// Conversion of XML-RPC values, which is how the parameter server speaks.
#include "node_parameters.h"

#include <ros/param.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/yaml_file.h"
#include "evolin_ros/dataset/camera_file.h"

namespace evolin::ros_shell {

namespace {

nlohmann::ordered_json toJson(XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeInvalid:
      return nullptr;
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value);
    case XmlRpc::XmlRpcValue::TypeInt:
      return static_cast<int>(value);
    case XmlRpc::XmlRpcValue::TypeDouble: {
      const double number = static_cast<double>(value);
      return std::isfinite(number) ? nlohmann::ordered_json(number)
                                   : nlohmann::ordered_json(formatDouble(number));
    }
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: {
      nlohmann::ordered_json array = nlohmann::ordered_json::array();
      // XmlRpcValue has iterators of structs alone.
      for (int i = 0; i < value.size(); ++i) {  // NOLINT(modernize-loop-convert)
        array.push_back(toJson(value[i]));
      }
      return array;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      nlohmann::ordered_json object = nlohmann::ordered_json::object();
      for (auto& [key, element] : value) {
        object[key] = toJson(element);
      }
      return object;
    }
    default:
      return "(binary data or a date)";
  }
}

}  // namespace

YAML::Node toYaml(XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeInvalid:
      return YAML::Node();
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value) ? "true" : "false");
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(formatDouble(static_cast<double>(value)));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      // XmlRpcValue has iterators of structs alone.
      for (int i = 0; i < value.size(); ++i) {  // NOLINT(modernize-loop-convert)
        list.push_back(toYaml(value[i]));
      }
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& [key, element] : value) {
        map[key] = toYaml(element);
      }
      return map;
    }
    default:
      throw Error("a parameter is binary data or a date; expected a number, text, list or map");
  }
}

YAML::Node privateParameters(const ros::NodeHandle& handle) {
  XmlRpc::XmlRpcValue value;
  return handle.getParam("", value) ? toYaml(value) : YAML::Node();
}

std::string toJsonText(const XmlRpc::XmlRpcValue& value) {
  return toJson(value).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string parametersAsJson(const std::string& name) {
  XmlRpc::XmlRpcValue value;
  return ros::param::get(name, value) ? toJsonText(value) : "null";
}

YAML::Node mergedParameters(const std::string& config, const YAML::Node& overrides) {
  YAML::Node merged(YAML::NodeType::Map);
  if (!config.empty()) {
    const std::string file = expandPath(config);
    const YAML::Node loaded = readYamlFile(file);
    if (!loaded.IsMap() && !loaded.IsNull()) {
      throw Error(file + ": expected a map of parameters");
    }
    merged = YAML::Clone(loaded.IsMap() ? loaded : merged);
  }
  if (overrides.IsMap()) {
    for (const auto& entry : overrides) {
      merged[entry.first.Scalar()] = entry.second;
    }
  }
  return merged;
}

std::string expandPath(const std::string& path) {
  if (path.empty()) {
    return path;
  }
  const char* home = std::getenv("HOME");
  if (path == "~" || path.rfind("~/", 0) == 0) {
    return std::string(home == nullptr ? "" : home) + path.substr(1);
  }
  // roslaunch starts nodes in ~/.ros but leaves PWD as it was in the shell of the caller.
  const char* called_from = std::getenv("PWD");
  const std::filesystem::path given(path);
  return given.is_relative() && called_from != nullptr
             ? (std::filesystem::path(called_from) / given).lexically_normal().string()
             : path;
}

Camera cameraOfParameter(const std::string& name_or_file, const std::filesystem::path& presets) {
  const std::filesystem::path name(name_or_file);
  const std::string extension = name.extension().string();
  const bool is_word = name_or_file.find('/') == std::string::npos;
  if (is_word && extension != ".yaml" && extension != ".yml" && extension != ".txt") {
    return loadCamera(name_or_file, presets);
  }
  const std::filesystem::path preset = presets / name;
  if (is_word && std::filesystem::is_regular_file(preset)) {
    return loadCamera(preset.string(), presets);
  }
  const std::string file = expandPath(name_or_file);
  if (is_word && !std::filesystem::exists(file)) {
    throw Error("camera " + quote(name_or_file) + ": there is neither " + preset.string() +
                " nor " + file + "; expected a preset or a file");
  }
  return loadCamera(file, presets);
}

}  // namespace evolin::ros_shell
