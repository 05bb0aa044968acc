// The pieces of work of a benchmark. Each leaves a folder that is there as a whole or not at all,
// and none when it throws.
#pragma once

#include <filesystem>

#include "benchmark_plan.h"
#include "evolin_ros/benchmarking/cell_record.h"

namespace evolin::cli {

/// Written last into the folder of lines.
constexpr const char* kDetectionFile = "detection.json";

struct BenchmarkContext {
  const BenchmarkMatrix& matrix;
  const BenchmarkPlan& plan;
  std::filesystem::path root;
};

bool isSequenceMade(const BenchmarkContext& context, std::size_t sequence);
bool isDetectionMade(const BenchmarkContext& context, std::size_t detection);

/// Makes a synthetic sequence, or lines, unless it is made. Throws Interrupted on Ctrl-C, else what
/// goes wrong. Two processes may ask for the same at once.
void makeSequence(const BenchmarkContext& context, std::size_t sequence);
void makeDetection(const BenchmarkContext& context, std::size_t detection);

/// Runs a cell whose sequence and lines are made; its folder gets the report and a finished record.
void runCell(const BenchmarkContext& context, std::size_t cell);

/// Puts a record that is not a finished one in place of what the cell's folder holds.
void recordCell(const BenchmarkContext& context, std::size_t cell, CellState state,
                const std::string& error);

}  // namespace evolin::cli
