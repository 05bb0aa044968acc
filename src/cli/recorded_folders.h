// Folders in EVOLIN's layout that detect and associate write.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/evaluation/front_end.h"
#include "output_folder.h"

namespace evolin::cli {

/// lines/NAME.csv and, where lines have scores, scores/NAME.csv a frame, and stamps.txt. NAME is
/// the image file's stem, or its number where the input has no files.
class LineRecorder : public FrontEndSink {
 public:
  LineRecorder(std::filesystem::path folder, bool scores);

  void takeImage(const ImagePart& image) override;
  void takeLines(const LineSet& lines, const ImagePart& image) override;
  void takeNote(const std::string& text) override { notes_.push_back(text); }

  /// Writes stamps.txt. Throws Error when stamps do not increase.
  void finish() const;

  std::size_t images() const { return images_; }
  std::size_t frames() const { return entries_.size(); }
  std::size_t lines() const { return lines_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::filesystem::path folder_;
  bool scores_;
  std::size_t images_ = 0;
  std::size_t lines_ = 0;
  std::vector<StampedFile> entries_;
  std::vector<std::string> notes_;
};

/// associations/FIRST_SECOND.csv a pair of frames, and stamps.txt of all frames.
class MatchRecorder : public FrontEndSink {
 public:
  explicit MatchRecorder(std::filesystem::path folder);

  void takeImage(const ImagePart& image) override;
  void takeMatches(const MatchSet& matches, const Frame& first, const Frame& second) override;
  void takeNote(const std::string& text) override { notes_.push_back(text); }

  /// As LineRecorder's.
  void finish() const;

  std::size_t images() const { return entries_.size(); }
  std::size_t pairs() const { return pairs_; }
  std::size_t matches() const { return matches_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::filesystem::path folder_;
  std::size_t pairs_ = 0;
  std::size_t matches_ = 0;
  std::vector<StampedFile> entries_;
  std::vector<std::string> notes_;
};

/// Takes the whole recording through a front-end, with progress on standard error unless `quiet`.
/// False when the user pressed Ctrl-C: what came before it was given on.
bool record(PartReader* reader, FrontEnd* front_end, FrontEndSink* sink, bool quiet);

/// What record() has made and what is said of it.
struct RecordedFolder {
  std::string output;   ///< as the user named the folder
  std::string marker;   ///< name of the file that tells whose folder it is
  std::string heading;  ///< its first lines: verb, input and settings
  std::string summary;
  std::vector<std::string> notes;
  bool complete = true;
};

/// Writes the marker, gives `folder` its final name, and tells the notes on standard error and the
/// summary on standard output. Throws Interrupted, after all that, when it is not complete.
void conclude(OutputFolder* folder, const RecordedFolder& recorded);

}  // namespace evolin::cli
