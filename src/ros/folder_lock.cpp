// flock on a file that carries its owner's name.
#include "folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "evolin_ros/base/error.h"

namespace evolin::ros_shell {

namespace {

constexpr char kFile[] = ".evaluator";
constexpr std::chrono::seconds kPatience(2);

std::string contentOf(int descriptor) {
  char text[512];
  const ssize_t size = pread(descriptor, text, sizeof text, 0);
  return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : "another evaluator";
}

/// False when the file was removed or replaced between its opening and its locking.
bool isStillThere(int descriptor, const std::filesystem::path& file) {
  struct stat opened {};
  struct stat named {};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& owner)
    : file_(folder / kFile) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
      throw Error(file_.string() + ": cannot be made (" + std::strerror(errno) + ")");
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string holder = contentOf(descriptor_);
      close(descriptor_);
      if (std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        continue;
      }
      throw Error("output_dir " + folder.string() + ": " + holder +
                  " writes its report there; expected a folder for " + owner + " alone");
    }
    if (isStillThere(descriptor_, file_)) {
      break;
    }
    close(descriptor_);
  }
  const std::string content = owner + " (process " + std::to_string(getpid()) + ")";
  // The name only serves the message to others.
  if (ftruncate(descriptor_, 0) != 0 ||
      write(descriptor_, content.data(), content.size()) != static_cast<ssize_t>(content.size())) {
    const int problem = errno;
    close(descriptor_);
    throw Error(file_.string() + ": cannot be written (" + std::strerror(problem) + ")");
  }
}

FolderLock::~FolderLock() {
  // Removed while it is still locked, so that nobody's new lock goes with it.
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  close(descriptor_);
}

}  // namespace evolin::ros_shell
