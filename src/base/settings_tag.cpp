// FNV-1a over a canonical text.
#include "evolin_ros/base/settings_tag.h"

#include <cstdint>
#include <cstdio>
#include <map>

namespace evolin {

namespace {

/// Lengths before texts: no two different trees share a text.
std::string canonical(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) {
    return "n";
  }
  if (node.IsSequence()) {
    std::string text = "[" + std::to_string(node.size()) + ":";
    for (const YAML::Node& element : node) {
      text += canonical(element);
    }
    return text;
  }
  if (node.IsMap()) {
    std::map<std::string, std::string> sorted;
    for (const auto& entry : node) {
      sorted[canonical(entry.first)] = canonical(entry.second);
    }
    std::string text = "{" + std::to_string(sorted.size()) + ":";
    for (const auto& [key, value] : sorted) {
      text += key + value;
    }
    return text;
  }
  return std::to_string(node.Scalar().size()) + ":" + node.Scalar();
}

}  // namespace

std::string settingsTag(const YAML::Node& settings) {
  if (!settings.IsDefined() || settings.IsNull() || (settings.IsMap() && settings.size() == 0)) {
    return {};
  }
  constexpr std::uint32_t kOffset = 2166136261U;
  constexpr std::uint32_t kPrime = 16777619U;
  std::uint32_t hash = kOffset;
  for (const char letter : canonical(settings)) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * kPrime;
  }
  char text[10];
  std::snprintf(text, sizeof text, "#%08x", static_cast<unsigned>(hash));
  return text;
}

}  // namespace evolin
