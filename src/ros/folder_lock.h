// Keeps a folder of results to one writer at a time, in this process and in all others.
#pragma once

#include <filesystem>
#include <string>

namespace evolin::ros_shell {

/// A lock file in the folder, held as long as this lives; a process that dies lets it go.
class FolderLock {
 public:
  /// `owner` is the node's name. Waits up to two seconds for a node that is just being unloaded,
  /// then throws Error naming the folder and the node that holds it. A file system without locks
  /// keeps nobody out.
  FolderLock(const std::filesystem::path& folder, const std::string& owner);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace evolin::ros_shell
