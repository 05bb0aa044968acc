// What the system tells of itself.
#include "evolin_ros/evaluation/provenance.h"

#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace evolin {

namespace {

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) {
      const std::size_t colon = line.find(':');
      return colon == std::string::npos ? line : line.substr(std::min(colon + 2, line.size()));
    }
  }
  return "unknown";
}

}  // namespace

std::string localTime(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  return std::string(text, std::strftime(text, sizeof text, format, &local));
}

void addMachine(Report* report) {
  utsname system{};
  uname(&system);
  report->provenance["machine"] = nlohmann::ordered_json{
      {"processor", processorName()},
      {"threads", std::thread::hardware_concurrency()},
      {"system", std::string(system.sysname) + " " + system.release},
      {"architecture",
       system.machine}}.dump();
  report->provenance["written"] = nlohmann::json(localTime("%Y-%m-%dT%H:%M:%S%z")).dump();
}

}  // namespace evolin
