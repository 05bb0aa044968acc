// A folder of index pairs between the lines of two frames, looked up by the frames' stamps.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Everything is read and checked by the constructor.
///
/// Files: FIRST_SECOND.csv (index pairs, see readIndexPairsCsv) of the folder itself, else of
/// `associations/` in it; FIRST and SECOND are stems that the stamps file names. Stamps: the file
/// given, else `stamps.txt` in the folder or beside a folder named `associations`.
class AssociationFolder {
 public:
  /// Largest difference between a stamp asked for and the one listed.
  static constexpr Stamp kTolerance = kNanosecondsPerSecond / 1000;

  /// Throws Error or ParseError naming file and row: no folder, no stamps file (saying what it
  /// holds), no pair files, a malformed row, a stem that is listed twice, or a pair of frames that
  /// the stamps file does not name.
  explicit AssociationFolder(const std::filesystem::path& folder,
                             const std::filesystem::path& stamps_file = {});

  /// Pairs of the frames at these two stamps, each the nearest one within kTolerance; none when
  /// either is not listed or there is no file of the two.
  std::optional<IndexPairs> at(Stamp first, Stamp second) const;

  /// Number of pair files.
  std::size_t size() const { return pairs_.size(); }

  /// The folder that the pair files are in.
  const std::filesystem::path& folder() const { return folder_; }

 private:
  using Stems = std::pair<std::string, std::string>;

  Stems stemsOf(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  std::vector<StampedFile> entries_;  ///< `file` holds the stem
  std::map<Stems, IndexPairs> pairs_;
};

}  // namespace evolin
