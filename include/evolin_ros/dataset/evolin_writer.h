// Writes a sequence as a folder in the EVOLIN layout.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/dataset/sequence_reader.h"

namespace evolin {

/// images/NNNN.png, depth/NNNN.png (16 bits, metres x the camera's depth_factor, 0: none),
/// gt_lines/NNNN.csv, and the lists stamps.txt, poses.txt (TUM's columns, row k is image k),
/// depth_associations.txt, calibration_matrix.txt. Ids go out as index pairs:
/// gt_associations_step1/ for neighbours, gt_associations_gaps/ for lines that come back after
/// frames without them; and as numbers, a row a line, in gt_ids/NNNN.csv.
class EvolinWriter {
 public:
  /// Files go into `folder`, which is made where it is missing.
  explicit EvolinWriter(const std::filesystem::path& folder);

  /// May be called from several threads, in any order; `number` counts images from 0 and gives the
  /// files their name. Throws Error naming the file that cannot be written.
  void addFrame(std::size_t number, const SequenceFrame& frame);

  /// Writes the lists. Throws Error when numbers are missing or given twice, stamps do not
  /// increase, or only some frames have a pose (rows would no longer fit).
  void finish();

  /// Four digits or more.
  static std::string stem(std::size_t number);

 private:
  struct Entry {
    Stamp stamp = 0;
    std::optional<Pose> pose;
    std::optional<Camera> camera;
    bool depth = false;
    std::optional<LineSegments> lines;
  };

  void writeLists() const;
  void writePoses() const;
  void writeAssociations() const;

  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::size_t, Entry> entries_;
};

}  // namespace evolin
