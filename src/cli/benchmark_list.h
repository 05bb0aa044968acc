// The cells of a benchmark as a table for people, or as JSON for programs that run them.
#pragma once

#include <string>
#include <vector>

#include "benchmark_tasks.h"

namespace evolin::cli {

/// `records` are those of the cells.
std::string cellTable(const std::vector<CellRecord>& records);

/// {"cells": [those of matrix.json, each with content_hash and detection (the id of the lines that
/// it plays, null: none)], "detections": [{id, sequence, detector, content_hash, made}]}.
std::string cellsJson(const BenchmarkContext& context, const std::vector<CellRecord>& records);

/// How many cells are in which state, and why those that are not finished are not.
std::string summaryOf(const std::vector<CellRecord>& records);

}  // namespace evolin::cli
