// Walking over a configuration in YAML so that every refusal names file and line.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

class ConfigFile {
 public:
  explicit ConfigFile(std::string file) : file_(std::move(file)) {}

  /// "FILE:LINE" of a node.
  std::string placeOf(const YAML::Node& node) const;

  /// A refusal of what stands at `node`.
  ParseError refusal(const YAML::Node& node, const std::string& message) const;

  /// `fill` reads all keys of the map `node`; its ConfigErrors, and those for keys that it leaves
  /// over, become ParseErrors with the line of their key.
  void walk(const YAML::Node& node, const std::string& owner,
            const std::function<void(ParameterReader*)>& fill) const;

  /// The elements of the list at `key`; none where the key is absent or null.
  std::vector<YAML::Node> list(const YAML::Node& map, const std::string& key) const;

  /// The name of a list's element, which is a name or a map with one. Throws ParseError where there
  /// is none, or one that cannot be part of a file's name.
  std::string nameOf(const YAML::Node& node, const std::string& kind) const;

 private:
  std::string file_;
};

}  // namespace evolin
