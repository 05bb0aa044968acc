// Where reports go and what they say of the machine.
#include "report_keeper.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "evolin_ros/base/error.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

namespace {

std::string timeText(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  return std::string(text, std::strftime(text, sizeof text, format, &local));
}

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

std::string machineAsJson() {
  utsname system{};
  uname(&system);
  return nlohmann::ordered_json{{"processor", processorName()},
                                {"threads", std::thread::hardware_concurrency()},
                                {"system", std::string(system.sysname) + " " + system.release},
                                {"architecture", system.machine}}
      .dump();
}

}  // namespace

ReportKeeper::ReportKeeper(const std::string& output_dir)
    : folder_(expandPath(output_dir.empty() ? "~/.ros/evolin_ros/" + timeText("%Y%m%d-%H%M%S")
                                            : output_dir)) {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem || access(folder_.c_str(), W_OK) != 0) {
    throw Error("output_dir " + folder_.string() + ": cannot be made or written to" +
                (problem ? " (" + problem.message() + ")" : ""));
  }
  replaces_earlier_ = std::filesystem::exists(folder_ / "report.json");
}

std::filesystem::path ReportKeeper::write(Report report, int newest_pass) {
  report.provenance["machine"] = machineAsJson();
  report.provenance["written"] = nlohmann::json(timeText("%Y-%m-%dT%H:%M:%S%z")).dump();
  const std::lock_guard<std::mutex> lock(mutex_);
  return writeReport(report, report.pass == newest_pass
                                 ? folder_
                                 : folder_ / ("pass_" + std::to_string(report.pass)));
}

}  // namespace evolin::ros_shell
