// Child processes of a test, a nodelet manager among them, which never outlive it.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace evolin::test {

/// Ends with the test: asked by SIGINT at destruction, made to after a while, and killed by the
/// system when the test itself dies.
class Process {
 public:
  /// `command` is looked up in PATH. Throws std::runtime_error when it cannot be started.
  explicit Process(const std::vector<std::string>& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;

  /// The exit status, or minus the signal that ended it; none when it still runs after `seconds`.
  std::optional<int> wait(double seconds);

  bool running() { return !wait(0); }

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

/// To how many nodes `node` sends on `topic`, as the node itself says; 0 when it does not answer.
std::size_t listenersOf(const std::string& node, const std::string& topic);

/// Waits until what `node` publishes on `topic` reaches `count` subscribing nodes; both are whole
/// names.
::testing::AssertionResult waitForListener(const std::string& node, const std::string& topic,
                                           std::size_t count = 1);

/// A nodelet manager in a process of its own, with four threads as manager.launch has it.
class Manager {
 public:
  /// Its name is `space`/manager. Returns when it takes nodelets and its log reaches /rosout;
  /// throws std::runtime_error otherwise.
  explicit Manager(const std::string& space, int threads = 4);

  /// Whether nodelet `space`/`name` of `type` started; `remappings` count from the namespace. Set
  /// its parameters before. Throws std::runtime_error when the manager does not answer.
  bool load(const std::string& name, const std::string& type,
            const std::map<std::string, std::string>& remappings = {});
  bool unload(const std::string& name);

  /// Waits until what the nodelets publish on `space`/`topic` reaches `count` nodes, this manager
  /// being one when a nodelet of its own listens.
  ::testing::AssertionResult waitForListener(const std::string& topic, std::size_t count = 1) const;

  const std::string& space() const { return space_; }
  Process& process() { return process_; }

 private:
  std::string space_;
  Process process_;
};

}  // namespace evolin::test
