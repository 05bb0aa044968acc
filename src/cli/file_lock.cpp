// flock.
#include "file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "evolin_ros/base/error.h"

namespace evolin::cli {

namespace {

int openLock(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    throw Error(file.string() + ": cannot be made: " + std::strerror(errno));
  }
  return descriptor;
}

int operationOf(LockKind kind) { return kind == LockKind::kShared ? LOCK_SH : LOCK_EX; }

}  // namespace

FileLock::FileLock(const std::filesystem::path& file, LockKind kind) : descriptor_(openLock(file)) {
  while (flock(descriptor_, operationOf(kind)) != 0 && errno == EINTR) {
  }
}

FileLock::FileLock(const std::filesystem::path& file, LockKind kind, double seconds,
                   const std::string& why_not)
    : descriptor_(openLock(file)) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (flock(descriptor_, operationOf(kind) | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    if (std::chrono::steady_clock::now() > deadline) {
      close(descriptor_);
      throw Error(why_not);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

FileLock::~FileLock() { close(descriptor_); }

}  // namespace evolin::cli
