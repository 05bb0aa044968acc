// Tasks of which some wait for others: which may begin, and what becomes of those behind a failure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace evolin {

/// Tasks are numbered as they are added; each waits for at most one other, added before it.
class TaskQueue {
 public:
  std::size_t add(std::optional<std::size_t> after);

  /// The lowest task that may begin, which counts as begun then; none where all have begun or wait.
  std::optional<std::size_t> next();

  /// A begun task has ended well.
  void finish(std::size_t task);

  /// It has not: the tasks that wait for it, directly or not, will never begin. Returns them.
  std::vector<std::size_t> fail(std::size_t task);

  /// Whether a task is begun and not ended, or may still begin.
  bool busy() const;

 private:
  enum class State { kWaiting, kReady, kBegun, kEnded };
  struct Task {
    std::optional<std::size_t> after;
    State state = State::kReady;
  };

  std::vector<Task> tasks_;
};

}  // namespace evolin
