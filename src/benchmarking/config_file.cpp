// Marks of nodes as lines.
#include "config_file.h"

#include <algorithm>
#include <cctype>

#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

int lineOf(const YAML::Node& node) { return node.Mark().line + 1; }

bool isName(const std::string& text) {
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  const auto is_part = [&](char c) { return is_letter(c) || c == '_' || c == '.' || c == '-'; };
  return !text.empty() && is_letter(text.front()) && text.back() != '-' && text != "none" &&
         text.find("--") == std::string::npos && std::all_of(text.begin(), text.end(), is_part);
}

}  // namespace

std::string ConfigFile::placeOf(const YAML::Node& node) const {
  return file_ + ":" + std::to_string(lineOf(node));
}

ParseError ConfigFile::refusal(const YAML::Node& node, const std::string& message) const {
  return ParseError(file_, lineOf(node), message);
}

void ConfigFile::walk(const YAML::Node& node, const std::string& owner,
                      const std::function<void(ParameterReader*)>& fill) const {
  try {
    ParameterReader reader(node, owner);
    fill(&reader);
    reader.finish();
  } catch (const ConfigError& error) {
    int line = lineOf(node);
    for (const auto& entry : node) {
      if (entry.first.IsScalar() && entry.first.Scalar() == error.key()) {
        line = lineOf(entry.first);  // the last one where a key stands twice
      }
    }
    throw ParseError(file_, line, error.what());
  }
}

std::vector<YAML::Node> ConfigFile::list(const YAML::Node& map, const std::string& key) const {
  const YAML::Node node = map[key];
  if (!node.IsDefined() || node.IsNull()) {
    return {};
  }
  if (!node.IsSequence()) {
    throw refusal(node, "'" + key + "': expected a list");
  }
  return {node.begin(), node.end()};
}

std::string ConfigFile::nameOf(const YAML::Node& node, const std::string& kind) const {
  const YAML::Node name = node.IsMap() ? node["name"] : node;
  if (!name.IsDefined() || !name.IsScalar()) {
    throw refusal(node, kind + ": expected a name, or a map with 'name'");
  }
  if (!isName(name.Scalar())) {
    throw refusal(name, kind + ": 'name' is " + quote(name.Scalar()) +
                            ", expected letters, digits, '_', '.' and single '-', and not 'none'");
  }
  return name.Scalar();
}

}  // namespace evolin
