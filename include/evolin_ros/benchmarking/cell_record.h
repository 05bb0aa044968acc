// What became of a cell, on disk: cell.json beside its report, matrix.json for all of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/benchmarking/matrix.h"

namespace evolin {

enum class CellState {
  kPending,  ///< not run yet, or run from other inputs, parameters or by another version
  kFinished,
  kFailed,
  kUnavailable  ///< a method or a sequence is not there
};

/// "pending", "finished", "failed", "unavailable".
std::string toString(CellState state);

constexpr const char* kCellFile = "cell.json";
constexpr const char* kMatrixFile = "matrix.json";

struct CellRecord {
  std::string id;
  std::string sequence;
  std::string detector;    ///< name or "none"
  std::string associator;  ///< the same
  std::string setting;
  std::string content_hash;  ///< of everything that the result depends on; "": unknown
  std::string program_version;
  CellState state = CellState::kPending;
  std::string error;   ///< why it failed or is not available; "": none
  double seconds = 0;  ///< that it took, detection apart
};

/// A record of a cell with its names and this program's version.
CellRecord recordOf(const BenchmarkMatrix& matrix, const BenchmarkCell& cell);

/// cell.json in `folder`; none where there is none, or one that cannot be read (of another version
/// of its form, say).
std::optional<CellRecord> readCellRecord(const std::filesystem::path& folder);

/// Throws Error naming the file.
void writeCellRecord(const CellRecord& record, const std::filesystem::path& folder);

/// The state that a cell of this content is in, by what `folder` holds: finished only with the
/// report of the same content.
CellRecord stateOf(CellRecord wanted, const std::filesystem::path& folder);

/// matrix.json as text: {"program_version", "cells": [...]} by the order of the matrix, each with
/// id, sequence, detector, detector_label, associator, associator_label, setting, content_hash
/// (null: unknown), state and reason (null: none). A cell's own cell.json is of this matrix when it
/// has the same content_hash. `records` are those of the cells.
std::string matrixJson(const BenchmarkMatrix& matrix, const std::vector<CellRecord>& records);

}  // namespace evolin
