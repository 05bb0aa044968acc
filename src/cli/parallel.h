// Independent pieces of work spread over threads.
#pragma once

#include <cstddef>
#include <functional>

namespace evolin::cli {

/// Runs work(task, worker) for every task in [0, tasks) on `workers` threads (at least 1); a worker
/// is never in two calls at a time. When calls throw, no new ones start, and the exception of the
/// lowest task is thrown on, so that the message does not depend on the number of threads. Throws
/// Interrupted when the user presses Ctrl-C.
void forEachTask(std::size_t tasks, int workers,
                 const std::function<void(std::size_t task, std::size_t worker)>& work);

}  // namespace evolin::cli
