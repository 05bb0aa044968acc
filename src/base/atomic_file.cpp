// Writing under a temporary name and renaming at the end.
#include "evolin_ros/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

constexpr std::size_t kLongestStem = 120;  // leaves room for the rest below most systems' 255 bytes

[[noreturn]] void throwUnwritable(const std::filesystem::path& file, const std::string& what,
                                  int reason) {
  throw Error(file.string() + ": " + what + ": " + std::generic_category().message(reason));
}

/// Makes the folder of `file` where it is missing and returns it, "." for a bare name.
std::filesystem::path makeFolderOf(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code reason;
  // Asked first: older libraries refuse to "make" a folder that is reached by a symbolic link.
  if (std::filesystem::is_directory(folder, reason)) return folder;
  std::filesystem::create_directories(folder, reason);
  if (reason) throwUnwritable(file, "cannot make its folder", reason.value());
  return folder;
}

}  // namespace

TemporaryFile::TemporaryFile(std::filesystem::path final_name)
    : final_name_(std::move(final_name)) {
  const std::string name = final_name_.filename().string();
  if (name.empty() || name == "." || name == "..") {
    throw Error("'" + final_name_.string() + "': expected the name of a file to write");
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(final_name_, ignored)) {
    throwUnwritable(final_name_, "cannot be written", EISDIR);
  }
  const std::filesystem::path folder = makeFolderOf(final_name_);
  // Hidden, so that a leftover of a killed program is not taken for data; the extension stays
  // because some libraries choose the format by it.
  const std::string stem = "." + final_name_.stem().string().substr(0, kLongestStem) + ".tmp-" +
                           std::to_string(getpid()) + "-";
  const std::string extension = final_name_.extension().string();
  for (int attempt = 0;; ++attempt) {
    path_ = folder / (stem + std::to_string(attempt) + extension);
    // Made at once and only where nothing stands: two threads never share a name. The permissions
    // are those of any new file, which mkstemp's are not.
    const int descriptor = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return;
    }
    if (errno != EEXIST) throwUnwritable(final_name_, "cannot be written", errno);
  }
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(path_, ignored);
}

void TemporaryFile::commit() {
  std::error_code reason;
  std::filesystem::rename(path_, final_name_, reason);
  if (reason) {
    throwUnwritable(final_name_, "cannot be put in place of " + path_.filename().string(),
                    reason.value());
  }
  committed_ = true;
}

void writeFileAtomically(const std::filesystem::path& file, std::string_view content) {
  TemporaryFile temporary(file);
  errno = 0;
  std::ofstream stream(temporary.path(), std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();  // the last bytes go out here; a full disk shows
  if (!stream) throwUnwritable(file, "cannot be written", errno != 0 ? errno : EIO);
  temporary.commit();
}

}  // namespace evolin
