// Where reports go and what they say of the machine.
#include "report_keeper.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/provenance.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

namespace {

constexpr char kPassPrefix[] = "pass_";

/// A folder that did not exist before, even when several nodes start in the same second.
std::filesystem::path makeNewFolder(const std::string& owner) {
  std::string name = owner;
  name.erase(0, name.find_first_not_of('/'));
  std::replace(name.begin(), name.end(), '/', '_');
  const std::filesystem::path home = expandPath("~/.ros/evolin_ros");
  const std::string first = localTime("%Y%m%d-%H%M%S") + (name.empty() ? "" : "-" + name);
  std::error_code problem;
  std::filesystem::create_directories(home, problem);
  for (int number = 1; !problem; ++number) {
    const std::filesystem::path folder =
        home / (number == 1 ? first : first + "-" + std::to_string(number));
    if (std::filesystem::create_directory(folder, problem)) {
      return folder;
    }
  }
  throw Error("output_dir " + (home / first).string() + ": cannot be made (" + problem.message() +
              ")");
}

/// "pass_" and a number, as write() names them.
bool isPassFolder(const std::filesystem::path& folder) {
  const std::string name = folder.filename().string();
  constexpr std::size_t kPrefix = sizeof(kPassPrefix) - 1;
  return name.size() > kPrefix && name.compare(0, kPrefix, kPassPrefix) == 0 &&
         name.find_first_not_of("0123456789", kPrefix) == std::string::npos;
}

}  // namespace

ReportKeeper::ReportKeeper(const std::string& output_dir, const std::string& owner)
    : folder_(output_dir.empty() ? makeNewFolder(owner)
                                 : std::filesystem::path(expandPath(output_dir))) {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem || access(folder_.c_str(), W_OK) != 0) {
    throw Error("output_dir " + folder_.string() + ": cannot be made or written to" +
                (problem ? " (" + problem.message() + ")" : ""));
  }
  lock_ = std::make_unique<FolderLock>(folder_, owner);
  replaces_earlier_ = std::filesystem::exists(folder_ / "report.json");
}

void ReportKeeper::startOver() {
  const std::lock_guard<std::mutex> lock(mutex_);
  passes_are_stale_ = true;
}

void ReportKeeper::removePasses() {
  std::error_code problem;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, problem)) {
    if (isPassFolder(entry.path())) {
      removeReport(entry.path());
    }
  }
}

std::filesystem::path ReportKeeper::write(Report report, int newest_pass) {
  addMachine(&report);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (std::exchange(passes_are_stale_, false)) {
    removePasses();
  }
  return writeReport(report, report.pass == newest_pass
                                 ? folder_
                                 : folder_ / (kPassPrefix + std::to_string(report.pass)));
}

}  // namespace evolin::ros_shell
