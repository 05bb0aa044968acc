// fork, and a pipe that closes when the child ends.
#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "evolin_ros/base/error.h"

namespace evolin::cli {

namespace {

constexpr int kFailed = 1;

bool writeAll(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t size = write(descriptor, text.data() + done, text.size() - done);
    if (size < 0 && errno != EINTR) {
      return false;
    }
    done += size > 0 ? static_cast<std::size_t>(size) : 0;
  }
  return true;
}

[[noreturn]] void runChild(const std::function<std::string()>& work, pid_t parent, int descriptor) {
  for (const int number : {SIGINT, SIGTERM, SIGPIPE}) {
    std::signal(number, SIG_DFL);
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {
    _exit(kFailed);  // it died before it could be watched
  }
  std::string text;
  bool done = false;
  try {
    text = work();
    done = true;
  } catch (const std::exception& error) {
    text = error.what();
  } catch (...) {
    text = "failed with something that is no std::exception";
  }
  std::cout.flush();
  std::cerr.flush();
  const bool told = writeAll(descriptor, text);
  // Not exit(): what the parent has registered is the parent's to run.
  _exit(done && told ? 0 : kFailed);
}

}  // namespace

ChildProcess::ChildProcess(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(std::string("cannot start a process: ") + std::strerror(errno));
  }
  // What waits in buffers would come out twice.
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) {
    const int reason = errno;
    close(ends[0]);
    close(ends[1]);
    throw Error(std::string("cannot start a process: ") + std::strerror(reason));
  }
  if (process_ == 0) {
    close(ends[0]);
    runChild(work, parent, ends[1]);
  }
  close(ends[1]);
  descriptor_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    kill(process_, SIGKILL);
    result();
  }
  close(descriptor_);
}

bool ChildProcess::advance() {
  char buffer[4096];
  const ssize_t size = read(descriptor_, buffer, sizeof buffer);
  if (size > 0) {
    received_.append(buffer, static_cast<std::size_t>(size));
  }
  return size == 0 || (size < 0 && errno != EINTR);
}

ChildResult ChildProcess::result() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  ended_ = true;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return {false, "ended by signal " + std::to_string(number) + " (" + strsignal(number) + ")"};
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0 && received_.empty()) {
    return {false, "ended with status " + std::to_string(WEXITSTATUS(status))};
  }
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, received_};
}

void ChildProcess::interrupt() const { kill(process_, SIGTERM); }

ChildResult runInChild(const std::function<std::string()>& work) {
  ChildProcess child(work);
  while (!child.advance()) {
  }
  return child.result();
}

}  // namespace evolin::cli
