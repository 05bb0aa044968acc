// The names under which plugins/*.xml register methods.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace evolin::test {

/// Names of the classes in the plug-in file (an XML of pluginlib); empty when it cannot be read.
inline std::set<std::string> pluginNames(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  const std::regex name("<class\\s+name=\"([^\"]+)\"");
  std::set<std::string> names;
  for (std::sregex_iterator match(text.begin(), text.end(), name), end; match != end; ++match) {
    names.insert((*match)[1]);
  }
  return names;
}

}  // namespace evolin::test
