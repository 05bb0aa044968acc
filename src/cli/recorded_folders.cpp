// Frame by frame as they come.
#include "recorded_folders.h"

#include <iostream>
#include <optional>
#include <utility>

#include "command.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/dataset/csv.h"
#include "interrupt.h"
#include "progress.h"

namespace evolin::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kImagesInBatch = 32;

/// A line a frame, in order of time, so that every name means one frame.
void addEntry(const ImagePart& image, const std::string& file, std::vector<StampedFile>* entries) {
  const Stamp stamp = image.frame.stamp;
  if (!entries->empty() && stamp <= entries->back().stamp) {
    throw Error("image " + image.frame.name + " at " + formatStamp(stamp) +
                " s comes after one at " + formatStamp(entries->back().stamp) +
                " s, expected stamps that increase: take one pass with --start and --duration");
  }
  entries->push_back({stamp, file});
}

}  // namespace

LineRecorder::LineRecorder(fs::path folder, bool scores)
    : folder_(std::move(folder)), scores_(scores) {
  fs::create_directories(folder_ / "lines");
  if (scores_) {
    fs::create_directories(folder_ / "scores");
  }
}

void LineRecorder::takeImage(const ImagePart& /*image*/) { ++images_; }

void LineRecorder::takeLines(const LineSet& lines, const ImagePart& image) {
  const std::string file = image.frame.name + ".csv";
  addEntry(image, "lines/" + file, &entries_);
  writeLinesCsv(folder_ / "lines" / file, lines.lines);
  if (scores_) {
    writeScoresCsv(folder_ / "scores" / file, lines.lines);
  }
  lines_ += lines.lines.size();
  if (lines.processing_time > 0) {
    times_[image.frame.name] = lines.processing_time;
  }
}

void LineRecorder::finish() const {
  writeStampsFile(folder_ / "stamps.txt", entries_);
  writeTimesFile(folder_ / kTimesFile, times_);
}

MatchRecorder::MatchRecorder(fs::path folder) : folder_(std::move(folder)) {
  fs::create_directories(folder_ / "associations");
}

void MatchRecorder::takeImage(const ImagePart& image) {
  addEntry(image, image.frame.name + ".csv", &entries_);
}

void MatchRecorder::takeMatches(const MatchSet& matches, const Frame& first, const Frame& second) {
  std::string rows;
  for (const LineMatch& match : matches.matches) {
    rows += std::to_string(match.first) + "," + std::to_string(match.second) + "\n";
  }
  writeFileAtomically(folder_ / "associations" / (first.name + "_" + second.name + ".csv"), rows);
  ++pairs_;
  matches_ += matches.matches.size();
}

void MatchRecorder::finish() const { writeStampsFile(folder_ / "stamps.txt", entries_); }

bool record(PartReader* reader, FrontEnd* front_end, FrontEndSink* sink, bool quiet) {
  const InterruptGuard guard;
  std::optional<Progress> progress;
  if (!quiet) {
    progress.emplace("frames", reader->images());
  }
  std::size_t done = 0;
  bool more = true;
  while (more && !guard.interrupted()) {
    std::vector<StreamPart> parts;
    for (std::size_t images = 0; more && images < kImagesInBatch;) {
      std::optional<StreamPart> part = reader->next();
      more = part.has_value();
      if (more) {
        images += std::holds_alternative<ImagePart>(*part) ? 1 : 0;
        done += std::holds_alternative<ImagePart>(*part) ? 1 : 0;
        parts.push_back(std::move(*part));
      }
    }
    front_end->process(std::move(parts), sink);
    if (progress) {
      progress->update(done);
    }
  }
  if (progress) {
    progress->finish(done);
  }
  for (const std::string& note : reader->notes()) {
    sink->takeNote(note);
  }
  if (const std::string note = front_end->note(); !note.empty()) {
    sink->takeNote(note);
  }
  return !more;
}

void conclude(OutputFolder* folder, const RecordedFolder& recorded) {
  writeFileAtomically(folder->path() / recorded.marker,
                      programVersion() + " " + recorded.heading + "\n" + recorded.summary + "\n" +
                          (recorded.complete ? "complete\n" : "incomplete\n"));
  folder->commit();
  for (const std::string& note : recorded.notes) {
    std::cerr << note << "\n";
  }
  std::cout << recorded.output << ": " << recorded.summary << "\n";
  if (!recorded.complete) {
    throw Interrupted("interrupted; what is done stands in " + recorded.output +
                      ", marked incomplete");
  }
}

}  // namespace evolin::cli
