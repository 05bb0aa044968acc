// A list small enough to walk over.
#include "evolin_ros/benchmarking/task_queue.h"

#include <algorithm>

namespace evolin {

std::size_t TaskQueue::add(std::optional<std::size_t> after) {
  const bool waits = after && tasks_[*after].state != State::kEnded;
  tasks_.push_back({after, waits ? State::kWaiting : State::kReady});
  return tasks_.size() - 1;
}

std::optional<std::size_t> TaskQueue::next() {
  const auto ready = std::find_if(tasks_.begin(), tasks_.end(),
                                  [](const Task& task) { return task.state == State::kReady; });
  if (ready == tasks_.end()) {
    return std::nullopt;
  }
  ready->state = State::kBegun;
  return static_cast<std::size_t>(ready - tasks_.begin());
}

void TaskQueue::finish(std::size_t task) {
  tasks_[task].state = State::kEnded;
  for (Task& other : tasks_) {
    if (other.after == task && other.state == State::kWaiting) {
      other.state = State::kReady;
    }
  }
}

std::vector<std::size_t> TaskQueue::fail(std::size_t task) {
  tasks_[task].state = State::kEnded;
  std::vector<std::size_t> lost;
  std::vector<std::size_t> failed = {task};
  for (std::size_t other = task + 1; other < tasks_.size(); ++other) {
    const std::optional<std::size_t>& after = tasks_[other].after;
    if (after && tasks_[other].state == State::kWaiting &&
        std::find(failed.begin(), failed.end(), *after) != failed.end()) {
      tasks_[other].state = State::kEnded;
      failed.push_back(other);
      lost.push_back(other);
    }
  }
  return lost;
}

bool TaskQueue::busy() const {
  return std::any_of(tasks_.begin(), tasks_.end(), [](const Task& task) {
    return task.state == State::kReady || task.state == State::kBegun;
  });
}

}  // namespace evolin
