// Names of parameters that differ, for people.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

namespace evolin::ros_shell {

/// "~a, ~b" of the names whose flag is set.
inline std::string changedNames(std::initializer_list<std::pair<const char*, bool>> differences) {
  std::string text;
  for (const auto& [name, differs] : differences) {
    if (differs) {
      text += (text.empty() ? "~" : ", ~") + std::string(name);
    }
  }
  return text;
}

}  // namespace evolin::ros_shell
