// --threads, the same for every verb.
#pragma once

#include <algorithm>
#include <string>
#include <thread>

#include "command.h"

namespace evolin::cli {

constexpr const char* kThreadsHelp =
    "worker threads, 0: one a core; the result does not depend on it";

/// The number of workers that the user means; throws UsageError below 0 and above 1024.
inline int checkedThreads(int threads) {
  constexpr int kMostThreads = 1024;
  if (threads < 0 || threads > kMostThreads) {
    throw UsageError("--threads: is " + std::to_string(threads) + ", expected 0 to " +
                     std::to_string(kMostThreads));
  }
  return threads > 0 ? threads
                     : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace evolin::cli
