// Keeps the report on disk up to date: what is in memory may be lost with the process, what is on
// disk not.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "evolin_ros/evaluation/report.h"
#include "folder_lock.h"

namespace evolin::ros_shell {

/// Safe for several threads.
class ReportKeeper {
 public:
  /// `output_dir` "" makes a new folder under ~/.ros/evolin_ros, named by date, time and `owner`,
  /// the node's name. Throws Error when the folder cannot be made or written to, or when another
  /// evaluator that runs writes there.
  ReportKeeper(const std::string& output_dir, const std::string& owner);

  const std::filesystem::path& folder() const { return folder_; }

  /// A report of an earlier run stood here and will be replaced, with those of its earlier passes.
  bool replacesEarlier() const { return replaces_earlier_; }

  /// Passes count from 1 again: the next writing removes the reports of the earlier ones.
  void startOver();

  /// The newest pass goes to the folder itself, an earlier one to pass_N in it. Adds the machine to
  /// the provenance. Returns the path of report.json; throws Error naming the file.
  std::filesystem::path write(Report report, int newest_pass);

 private:
  void removePasses();

  std::filesystem::path folder_;
  std::unique_ptr<FolderLock> lock_;
  bool replaces_earlier_ = false;
  std::mutex mutex_;
  bool passes_are_stale_ = true;  ///< guarded by mutex_
};

}  // namespace evolin::ros_shell
