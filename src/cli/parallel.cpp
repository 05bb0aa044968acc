// A counter that workers take tasks from.
#include "parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "command.h"
#include "interrupt.h"

namespace evolin::cli {

void forEachTask(std::size_t tasks, int workers,
                 const std::function<void(std::size_t task, std::size_t worker)>& work) {
  const InterruptGuard guard;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t failed_task = tasks;

  // Tasks are taken in order and a taken one is always finished, so every task below a failed one
  // has run when the workers end: the lowest failure is the same for any number of workers.
  const auto loop = [&](std::size_t worker) {
    while (!stop && !guard.interrupted()) {
      const std::size_t task = next++;
      if (task >= tasks) {
        return;
      }
      try {
        work(task, worker);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        stop = true;
        if (task < failed_task) {
          failed_task = task;
          error = std::current_exception();
        }
      }
    }
  };
  std::vector<std::thread> threads;
  for (int worker = 1; worker < workers; ++worker) {
    threads.emplace_back(loop, static_cast<std::size_t>(worker));
  }
  loop(0);
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (error) {
    std::rethrow_exception(error);
  }
  if (guard.interrupted()) {
    throw Interrupted("interrupted; nothing was written");
  }
}

}  // namespace evolin::cli
