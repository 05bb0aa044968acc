// What a benchmark's matrix comes to on this machine: which methods and sequences are there, and by
// which digest every result is known again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/benchmarking/matrix.h"
#include "recording_input.h"

namespace evolin::cli {

struct PlannedSequence {
  std::string unavailable;  ///< why it cannot be read; "": it can
  std::string digest;       ///< of all that it is made of
};

/// Lines of one detector on one sequence, found once for all cells.
struct PlannedDetection {
  std::string id;  ///< SEQUENCE--DETECTOR
  std::size_t sequence = 0;
  std::size_t detector = 0;
  std::string content_hash;
};

struct PlannedCell {
  std::string unavailable;
  std::string content_hash;
  std::optional<std::size_t> detection;  ///< whose lines are played
  std::string lines_folder;              ///< recorded elsewhere; "": not
  std::string matches_folder;            ///< the same
};

/// By the places of the matrix.
struct BenchmarkPlan {
  std::vector<PlannedSequence> sequences;
  std::vector<PlannedDetection> detections;
  std::vector<PlannedCell> cells;
};

/// Folders of a benchmark.
std::filesystem::path sequenceFolder(const std::filesystem::path& root, const std::string& name);
std::filesystem::path detectionFolder(const std::filesystem::path& root, const std::string& id);
std::filesystem::path cellFolder(const std::filesystem::path& root, const std::string& id);

/// Tells `input` of a sequence in the words of the command line. Throws UsageError.
void setInput(const BenchmarkSequence& sequence, const std::filesystem::path& root,
              RecordingInput* input);

/// Looks at everything, in a process of its own: plug-ins may start threads, which the processes of
/// the cells would not get. Digests of files are remembered in `root`; "": nowhere. Throws Error
/// naming the place in the configuration for parameters that a method does not take and for options
/// that do not go with an input.
BenchmarkPlan makePlan(const BenchmarkMatrix& matrix, const std::filesystem::path& root);

}  // namespace evolin::cli
