// Cells in processes of their own, several at once, each behind the lines that it plays.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "benchmark_tasks.h"

namespace evolin::cli {

struct RunnerOptions {
  int jobs = 1;
  bool quiet = false;  ///< no line on standard error for each piece of work
};

/// Runs the cells at `places`, and before them what they need; what fails is recorded and does not
/// keep others from running. Calls `changed` with a cell's place once its folder says what became
/// of it. Returns false when the user pressed Ctrl-C: what is done stays.
bool runCells(const BenchmarkContext& context, const std::vector<std::size_t>& places,
              const RunnerOptions& options, const std::function<void(std::size_t)>& changed);

/// The same of lines alone; throws Error with the first failure.
bool runDetections(const BenchmarkContext& context, const std::vector<std::size_t>& detections,
                   const RunnerOptions& options);

}  // namespace evolin::cli
