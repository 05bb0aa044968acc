// The matrix of a benchmark: sequences, detectors, associators and settings, and the cells that
// they make.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "evolin_ros/evaluation/metric_family.h"
#include "evolin_ros/geometry/line_selection.h"

namespace evolin {

/// Names are parts of file names: letters, digits, '_', '.' and single '-', beginning with a letter
/// or a digit. "none" stands for no method.
struct BenchmarkSequence {
  std::string name;
  std::string place;  ///< "FILE:LINE" in the configuration, as in the next structures
  std::optional<synthetic::SyntheticOptions> synthetic;  ///< made by the benchmark itself
  std::vector<std::filesystem::path> inputs;  ///< bags, or one folder; none of a synthetic one
  /// What else 'evolin run' is told of an input, by the long names of its options ("layout",
  /// "pose-offset"); the value of an option without one is empty.
  std::vector<std::pair<std::string, std::string>> options;
  MetricFamilies metrics;  ///< that may be asked of it
};

struct BenchmarkMethod {
  std::string name;
  std::string place;
  std::string label;   ///< for tables
  std::string plugin;  ///< "": only recorded
  YAML::Node parameters = YAML::Node(YAML::NodeType::Map);
  /// Folder of results that are played where the plug-in is not available; {sequence} stands for a
  /// sequence's name, and of an associator {detector} for a detector's. "": none.
  std::string recorded;

  // Of detectors alone:
  std::optional<double> repeatability_threshold;  ///< lines of a score above it are measured, too
  std::optional<double> pose_threshold;           ///< lines of a score above it are associated
  YAML::Node evaluation = YAML::Node(YAML::NodeType::Map);  ///< goes over the setting's
};

struct BenchmarkSetting {
  std::string name;
  std::string place;
  MetricFamilies metrics;
  bool associate_ground_truth = true;  ///< else the detected lines
  LineSelection selection;
  YAML::Node evaluation = YAML::Node(YAML::NodeType::Map);  ///< without metrics

  // Places in the matrix.
  std::vector<std::size_t> sequences;
  std::vector<std::size_t> detectors;    ///< empty: none
  std::vector<std::size_t> associators;  ///< empty: none
};

struct BenchmarkCell {
  std::string id;  ///< SEQUENCE--DETECTOR--ASSOCIATOR--SETTING
  std::size_t sequence = 0;
  std::optional<std::size_t> detector;
  std::optional<std::size_t> associator;
  std::size_t setting = 0;
  YAML::Node evaluation;  ///< keys of readEvaluationSettings(), `metrics` among them
  LineSelection selection;
};

struct BenchmarkMatrix {
  std::vector<BenchmarkSequence> sequences;
  std::vector<BenchmarkMethod> detectors;
  std::vector<BenchmarkMethod> associators;
  std::vector<BenchmarkSetting> settings;
  std::vector<BenchmarkCell> cells;  ///< by sequence, setting, detector, associator
};

/// Whether a family looks at matches, or at detected lines.
bool needsMatches(MetricFamily family);
bool needsDetector(MetricFamily family, bool associate_ground_truth);

/// Fills `cells`. A cell measures what both its setting and its sequence name; where that leaves
/// nothing, there is no cell, and where it needs no detector or no associator, there is one cell
/// instead of one for each. Throws Error where a detector's threshold for poses would cut the lines
/// that another family of the same cell measures.
void expandCells(BenchmarkMatrix* matrix);

/// "NAME", or "none".
std::string detectorName(const BenchmarkMatrix& matrix, const BenchmarkCell& cell);
std::string associatorName(const BenchmarkMatrix& matrix, const BenchmarkCell& cell);

/// Reads a configuration (docs/BENCHMARK.md has its form) and expands it. Relative paths start from
/// `data`; "": from the file's own folder. Throws ParseError with line, key, value and what was
/// expected.
BenchmarkMatrix readBenchmarkMatrix(const std::filesystem::path& file,
                                    const std::filesystem::path& data);

}  // namespace evolin
