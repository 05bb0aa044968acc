// An output folder that is there as a whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace evolin::cli {

/// A hidden folder beside the final one; commit() gives it the final name, the destructor removes
/// it when nobody committed. `marker` is a file that the caller writes into it: only a folder that
/// holds one is ever replaced, so that a slip in a path costs nobody's data.
class OutputFolder {
 public:
  /// Throws Error when something stands at `final_name` that is not an empty folder, unless `force`
  /// and it holds `marker`; also when the folder cannot be made.
  OutputFolder(const std::filesystem::path& final_name, const std::string& marker, bool force);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Throws Error when the rename fails; what stood there before stays then.
  void commit();

 private:
  std::filesystem::path final_name_;
  std::filesystem::path path_;
  bool committed_ = false;
};

}  // namespace evolin::cli
