// Where the real input of benchmarks stands, and how they say that they run without it: times of
// other input do not compare.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

namespace evolin::benchmark_input {

/// The folder `name` ("data/...") below the one that EVOLIN_SHARED names; "" where there is none,
/// which the first call for it says on standard error.
inline std::filesystem::path realInput(const std::string& name) {
  const char* const shared = std::getenv("EVOLIN_SHARED");
  if (shared != nullptr && *shared != '\0') {
    const std::filesystem::path folder = std::filesystem::path(shared) / name;
    if (std::filesystem::is_directory(folder)) {
      return folder;
    }
  }
  static std::set<std::string> told;
  if (told.insert(name).second) {
    std::fprintf(stderr,
                 "generated input: EVOLIN_SHARED names no folder with %s; times do not compare\n",
                 name.c_str());
  }
  return {};
}

}  // namespace evolin::benchmark_input
