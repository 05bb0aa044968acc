// Digests of input files, remembered so that a benchmark that is started again need not read them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace evolin {

/// Not safe for several threads.
class DigestCache {
 public:
  /// `file` holds what an earlier one saved; where it is absent or unreadable, nothing is known.
  explicit DigestCache(std::filesystem::path file);

  /// SHA-256 of a file; it is read again where its size or its time of change is another, or so new
  /// that a change might not show. Throws Error naming a file that cannot be read.
  std::string digestOf(const std::filesystem::path& file);

  /// One digest of files and folders: of the names (relative to the folder that was named) and
  /// digests of all files in them but hidden ones. Throws Error naming what is not there.
  std::string digestOf(const std::vector<std::filesystem::path>& places);

  /// Keeps what was asked for. Throws Error when the file cannot be written.
  void save() const;

 private:
  std::filesystem::path file_;
  std::map<std::string, std::string> known_;  ///< by path, size and time
  std::map<std::string, std::string> asked_;
};

/// SHA-256 of a text.
std::string digestOfText(const std::string& text);

}  // namespace evolin
