// Files that are either there as a whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace evolin {

/// Writes `content` to a temporary name in the same folder (made if missing) and renames it over
/// `file`. Throws Error naming the file and the system's reason; an older file is left as it was
/// then.
void writeFileAtomically(const std::filesystem::path& file, std::string_view content);

/// A temporary name for a file that another library writes; commit() renames it to the final name,
/// the destructor removes it when nobody committed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path final_name);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Throws Error when the rename fails.
  void commit();

 private:
  std::filesystem::path final_name_;
  std::filesystem::path path_;
  bool committed_ = false;
};

}  // namespace evolin
