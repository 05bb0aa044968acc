// A folder of line files (annotations, or the recorded output of any method) looked up by frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Everything is read and checked by the constructor; look-ups never fail on content.
///
/// Files: the *.csv of the folder itself, else of `gt_lines/`, else of `lines/` in it. Scores: of a
/// `scores/` in the folder, or beside a folder named `lines`; then every line file needs one.
/// Stamps: the file given, else `stamps.txt` in the folder (for `lines` also beside it); every
/// entry names a line file by its stem ("rgb/0000.png" means 0000.csv).
/// Ids: chained from the index pairs of every `gt_associations*/STEM_STEM.csv` in the folder, or
/// beside a `gt_lines` folder; lines in no pair get an id of their own; ids are dense, from 0, by
/// first appearance (files by name, then rows). Without such folders -1, or the row with
/// `same_rows`.
class AnnotationFolder {
 public:
  /// Largest difference between the stamp asked for and the one listed.
  static constexpr Stamp kTolerance = kNanosecondsPerSecond / 1000;

  /// Throws Error or ParseError naming file and row: no folder, no line files, a malformed row, a
  /// missing score file, an entry of the stamps file without a line file, two entries for one file,
  /// a pair file of unknown frames, an index beyond the lines of its frame, a chain with two lines
  /// of one frame, and with `same_rows` a first frame whose number of lines differs.
  explicit AnnotationFolder(const std::filesystem::path& folder,
                            const std::filesystem::path& stamps_file = {}, bool same_rows = false);

  /// Lines of the frame whose file stem is `stem`; none when it has no file.
  std::optional<LineSegments> byName(const std::string& stem) const;

  /// Whether at() can be asked, that is, whether there is a stamps file.
  bool hasStamps() const { return !entries_.empty(); }

  /// Lines of the entry nearest to `stamp` within kTolerance; none when there is no such entry.
  /// Throws Error saying how to make a stamps file when hasStamps() is false.
  std::optional<LineSegments> at(Stamp stamp) const;

  /// The stem of the file whose lines at() gives, none where it gives none; throws as that.
  std::optional<std::string> nameAt(Stamp stamp) const;

  /// Of the stamps file, none without one.
  std::optional<Stamp> firstStamp() const;
  std::optional<Stamp> lastStamp() const;

  bool hasScores() const { return has_scores_; }
  bool hasIds() const { return has_ids_; }

  /// Number of line files, and how many of them no entry of the stamps file names.
  std::size_t size() const { return frames_.size(); }
  std::size_t unlisted() const { return hasStamps() ? frames_.size() - entries_.size() : 0; }

  /// Stems of the line files in alphabetical order.
  const std::vector<std::string>& names() const { return names_; }

  /// The folder that the line files are in.
  const std::filesystem::path& folder() const { return folder_; }

  /// How frames find their lines here, as a sentence for messages.
  std::string matchingRule() const;

 private:
  void readLines(const std::filesystem::path& scores);
  void readStamps(const std::filesystem::path& file);

  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::vector<LineSegments> frames_;
  std::unordered_map<std::string, std::size_t> index_;  ///< stem to place in frames_
  std::vector<StampedFile> entries_;                    ///< `file` holds the stem
  bool has_scores_ = false;
  bool has_ids_ = false;
};

}  // namespace evolin
