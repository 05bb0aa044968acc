// Keeps the report on disk up to date: what is in memory may be lost with the process, what is on
// disk not.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "evolin_ros/evaluation/report.h"

namespace evolin::ros_shell {

/// Safe for several threads.
class ReportKeeper {
 public:
  /// `output_dir` "" makes a new folder under ~/.ros/evolin_ros, named by date and time. Throws
  /// Error when the folder cannot be made or written to.
  explicit ReportKeeper(const std::string& output_dir);

  const std::filesystem::path& folder() const { return folder_; }

  /// A report of an earlier run stood here and will be replaced.
  bool replacesEarlier() const { return replaces_earlier_; }

  /// The newest pass goes to the folder itself, an earlier one to pass_N in it. Adds the machine to
  /// the provenance. Returns the path of report.json; throws Error naming the file.
  std::filesystem::path write(Report report, int newest_pass);

 private:
  std::filesystem::path folder_;
  bool replaces_earlier_ = false;
  std::mutex mutex_;
};

}  // namespace evolin::ros_shell
