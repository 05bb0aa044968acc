// A lock among processes, held as long as an object lives.
#pragma once

#include <filesystem>
#include <string>

namespace evolin::cli {

enum class LockKind { kShared, kExclusive };

/// The system lets it go when the process, and every copy that was made of it since, has ended. The
/// file stays. On a file system without locks nobody is kept out.
class FileLock {
 public:
  /// Waits as long as it takes.
  explicit FileLock(const std::filesystem::path& file, LockKind kind = LockKind::kExclusive);

  /// Waits up to `seconds`, then throws Error with `why_not`.
  FileLock(const std::filesystem::path& file, LockKind kind, double seconds,
           const std::string& why_not);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace evolin::cli
