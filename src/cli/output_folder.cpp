// Making under a hidden name, swapping at the end.
#include "output_folder.h"

#include <unistd.h>

#include <system_error>

#include "evolin_ros/base/error.h"

namespace evolin::cli {

namespace fs = std::filesystem;

namespace {

fs::path hiddenBeside(const fs::path& folder, const std::string& what) {
  return folder.parent_path() /
         ("." + folder.filename().string() + "." + what + "-" + std::to_string(getpid()));
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& final_name, const std::string& marker, bool force)
    : final_name_(fs::absolute(final_name).lexically_normal()) {
  if (final_name_.filename().empty()) {  // "DIR/"
    final_name_ = final_name_.parent_path();
  }
  if (fs::exists(final_name_)) {
    const bool is_folder = fs::is_directory(final_name_);
    if (!is_folder || (!fs::is_empty(final_name_) && !fs::exists(final_name_ / marker))) {
      throw Error(
          final_name_.string() + ": exists and holds no " + marker +
          " of an earlier run, expected a new or an empty folder; nothing else is replaced");
    }
    if (!fs::is_empty(final_name_) && !force) {
      throw Error(final_name_.string() + ": exists; --force replaces it");
    }
  }
  path_ = hiddenBeside(final_name_, "tmp");
  std::error_code reason;
  fs::create_directories(final_name_.parent_path(), reason);
  if (!reason && !fs::create_directory(path_, reason) && !reason) {
    reason = std::make_error_code(std::errc::file_exists);
  }
  if (reason) {
    throw Error(path_.string() + ": cannot be made: " + reason.message());
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_) {
    fs::remove_all(path_, ignored);
  }
}

void OutputFolder::commit() {
  std::error_code reason;
  const fs::path old = hiddenBeside(final_name_, "old");
  const bool replaces = fs::exists(final_name_);
  if (replaces) {
    fs::rename(final_name_, old, reason);
  }
  if (!reason) {
    fs::rename(path_, final_name_, reason);
    if (reason && replaces) {
      std::error_code ignored;
      fs::rename(old, final_name_, ignored);
    }
  }
  if (reason) {
    throw Error(final_name_.string() + ": cannot be put in place: " + reason.message());
  }
  committed_ = true;
  if (replaces) {
    fs::remove_all(old, reason);  // a leftover is hidden and harmless
  }
}

}  // namespace evolin::cli
