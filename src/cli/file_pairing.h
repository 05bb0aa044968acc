// Files of several folders that belong together by their stem.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace evolin::cli {

/// Files of one folder by stem.
struct FileSet {
  std::string what;  ///< for messages, for example "predicted lines"
  std::filesystem::path folder;
  std::map<std::string, std::filesystem::path> files;

  /// The file with this stem; throws Error naming the stem and the folder when there is none.
  const std::filesystem::path& at(const std::string& stem) const;
};

/// Throws Error when the folder is missing, holds no file with one of `extensions`, or holds two
/// with the same stem.
FileSet listByStem(const std::string& what, const std::filesystem::path& folder,
                   const std::vector<std::string>& extensions);

/// Throws Error naming the first stem that only one of the two has.
void requireSameStems(const FileSet& first, const FileSet& second);

}  // namespace evolin::cli
