// Work in a process of its own: a crash ends that process, not the program.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace evolin::cli {

struct ChildResult {
  bool done = false;  ///< the work returned
  std::string text;   ///< what it returned, else why it did not
};

/// The work runs in a copy of this process, which must have no other threads. It starts with the
/// default signal handlers, and is killed when this process dies.
class ChildProcess {
 public:
  /// Throws Error when the system refuses.
  explicit ChildProcess(const std::function<std::string()>& work);
  ~ChildProcess();  ///< Kills it where it still runs.
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Becomes readable, as poll() has it, when something can be read or it has ended.
  int descriptor() const { return descriptor_; }

  /// Reads what there is; true once it has ended.
  bool advance();

  /// Once it has ended.
  ChildResult result();

  /// Asks it to end.
  void interrupt() const;

 private:
  pid_t process_ = -1;
  int descriptor_ = -1;
  bool ended_ = false;
  std::string received_;
};

/// Runs the work to its end in another process.
ChildResult runInChild(const std::function<std::string()>& work);

}  // namespace evolin::cli
