// Reading of annotation folders and the look-up of a frame's lines.
#include "evolin_ros/dataset/annotation_folder.h"

#include <algorithm>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "line_chains.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

bool hasCsvFiles(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    return false;
  }
  const fs::directory_iterator files(folder);
  return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    return entry.is_regular_file() && entry.path().extension() == ".csv";
  });
}

// "lines" of "DIR/lines" and of "DIR/lines/" alike.
std::string folderName(const fs::path& folder) {
  const fs::path plain = fs::weakly_canonical(folder);
  return plain.filename().string();
}

fs::path parentOf(const fs::path& folder) { return fs::weakly_canonical(folder).parent_path(); }

fs::path findLineFolder(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw Error(folder.string() + ": not a folder, expected one of line files (NNNN.csv)");
  }
  for (const fs::path& candidate : {folder, folder / "gt_lines", folder / "lines"}) {
    if (hasCsvFiles(candidate)) {
      return candidate;
    }
  }
  throw Error(folder.string() +
              ": no line files, expected *.csv in the folder itself, in gt_lines/ or in lines/");
}

fs::path findScores(const fs::path& folder, const fs::path& lines) {
  std::vector<fs::path> candidates = {folder / "scores", lines / "scores"};
  if (folderName(lines) == "lines") {
    candidates.push_back(parentOf(lines) / "scores");
  }
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [](const fs::path& path) { return fs::is_directory(path); });
  return found == candidates.end() ? fs::path() : *found;
}

fs::path findStamps(const fs::path& folder, const fs::path& lines) {
  std::vector<fs::path> candidates = {folder / "stamps.txt", lines / "stamps.txt"};
  if (folderName(lines) == "lines") {
    candidates.push_back(parentOf(lines) / "stamps.txt");
  }
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [](const fs::path& path) { return fs::exists(path); });
  return found == candidates.end() ? fs::path() : *found;
}

std::vector<fs::path> findAssociations(const fs::path& folder, const fs::path& lines) {
  std::vector<fs::path> places = {fs::weakly_canonical(folder), fs::weakly_canonical(lines)};
  if (folderName(lines) == "gt_lines") {
    places.push_back(parentOf(lines));
  }
  std::vector<fs::path> found;
  for (const fs::path& place : places) {
    for (const fs::directory_entry& entry : fs::directory_iterator(place)) {
      if (entry.is_directory() &&
          entry.path().filename().string().rfind("gt_associations", 0) == 0) {
        found.push_back(entry.path());
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void numberByRow(const fs::path& folder, const std::vector<std::string>& names,
                 std::vector<LineSegments>* frames) {
  for (std::size_t frame = 0; frame < frames->size(); ++frame) {
    LineSegments& lines = (*frames)[frame];
    if (lines.size() != frames->front().size()) {
      throw Error((folder / (names[frame] + ".csv")).string() + ": " +
                  std::to_string(lines.size()) + " lines, expected " +
                  std::to_string(frames->front().size()) + " as in " + names.front() +
                  ".csv: rows name the same line only when every frame has equally many");
    }
    for (std::size_t row = 0; row < lines.size(); ++row) {
      lines[row].id = static_cast<std::int64_t>(row);
    }
  }
}

}  // namespace

AnnotationFolder::AnnotationFolder(const fs::path& folder, const fs::path& stamps_file,
                                   bool same_rows)
    : folder_(findLineFolder(folder)) {
  readLines(findScores(folder, folder_));
  const std::vector<fs::path> associations = findAssociations(folder, folder_);
  if (!associations.empty()) {
    chainLineIds(associations, index_, names_, &frames_);
    has_ids_ = true;
  } else if (same_rows) {
    numberByRow(folder_, names_, &frames_);
    has_ids_ = true;
  }
  const fs::path stamps = stamps_file.empty() ? findStamps(folder, folder_) : stamps_file;
  if (!stamps.empty()) {
    readStamps(stamps);
  }
}

void AnnotationFolder::readLines(const fs::path& scores) {
  has_scores_ = !scores.empty();
  for (const fs::path& file : listFiles(folder_, {".csv"})) {
    const std::string stem = file.stem().string();
    if (has_scores_) {
      const fs::path score_file = scores / (stem + ".csv");
      if (!fs::exists(score_file)) {
        throw Error(score_file.string() + ": missing, expected the scores of the lines of frame " +
                    stem);
      }
      frames_.push_back(readScoredLinesCsv(file, score_file));
    } else {
      frames_.push_back(readLinesCsv(file));
    }
    if (!index_.emplace(stem, names_.size()).second) {
      throw Error(file.string() + ": a second line file of frame " + stem + ", expected one");
    }
    names_.push_back(stem);
  }
}

void AnnotationFolder::readStamps(const fs::path& file) {
  entries_ = readStampsFile(file);
  if (entries_.empty()) {
    throw ParseError(file.string(), 0, "no entries, expected lines \"stamp file\"");
  }
  std::unordered_map<std::string, Stamp> seen;
  for (StampedFile& entry : entries_) {
    // A name without extension may hold a point of its own (a TUM stamp).
    const fs::path name = fs::path(entry.file).filename();
    const std::string stem = (index_.count(name.string()) > 0 ? name : name.stem()).string();
    if (index_.count(stem) == 0) {
      throw ParseError(file.string(), 0,
                       "the entry " + formatStamp(entry.stamp) + " " + quote(entry.file) +
                           " has no line file, expected " + (folder_ / (stem + ".csv")).string());
    }
    const auto [earlier, is_new] = seen.emplace(stem, entry.stamp);
    if (!is_new) {
      throw ParseError(file.string(), 0,
                       "frame " + quote(stem) + " is listed at " + formatStamp(earlier->second) +
                           " and at " + formatStamp(entry.stamp) + ", expected one entry a file");
    }
    entry.file = stem;
  }
}

std::optional<LineSegments> AnnotationFolder::byName(const std::string& stem) const {
  const auto found = index_.find(stem);
  return found == index_.end() ? std::nullopt : std::make_optional(frames_[found->second]);
}

std::optional<std::string> AnnotationFolder::nameAt(Stamp stamp) const {
  if (!hasStamps()) {
    throw Error(folder_.string() +
                ": no stamps.txt, so that lines cannot be found by time; expected a file with "
                "lines \"stamp file\" such as \"1305031453.359684 0000.csv\"");
  }
  const StampedFile* entry = findNearest(entries_, stamp, kTolerance);
  return entry == nullptr ? std::nullopt : std::make_optional(entry->file);
}

std::optional<LineSegments> AnnotationFolder::at(Stamp stamp) const {
  const std::optional<std::string> name = nameAt(stamp);
  return name ? byName(*name) : std::nullopt;
}

std::optional<Stamp> AnnotationFolder::firstStamp() const {
  return hasStamps() ? std::make_optional(entries_.front().stamp) : std::nullopt;
}

std::optional<Stamp> AnnotationFolder::lastStamp() const {
  return hasStamps() ? std::make_optional(entries_.back().stamp) : std::nullopt;
}

std::string AnnotationFolder::matchingRule() const {
  if (hasStamps()) {
    return "line files are matched with images by stamps.txt within 0.001 s (listed: " +
           formatStamp(entries_.front().stamp) + " to " + formatStamp(entries_.back().stamp) + ")";
  }
  return "line files are matched with images by the file's stem (the first is " + names_.front() +
         ".csv; a stamps.txt there would match by time)";
}

}  // namespace evolin
