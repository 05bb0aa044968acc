// Lines by stamp instead of by pixels.
#include "evolin_ros/detection/recorded_detector.h"

#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "detector recorded";

/// Of the folder that was named, or of the one that its lines were found in and what is around it.
ProcessingTimes findTimes(const std::filesystem::path& folder, const std::filesystem::path& lines) {
  const std::filesystem::path whole = std::filesystem::weakly_canonical(lines);
  for (const std::filesystem::path& place : {folder, whole, whole.parent_path()}) {
    const std::filesystem::path file = place / kTimesFile;
    if ((place != whole.parent_path() || whole.filename() == "lines") &&
        std::filesystem::exists(file)) {
      return readTimesFile(file);
    }
  }
  return {};
}

}  // namespace

void RecordedDetector::configure(const YAML::Node& parameters) {
  std::string folder;
  std::string stamps;
  ParameterReader reader(parameters, kOwner);
  reader.read("folder", &folder);
  reader.read("stamps", &stamps);
  reader.finish();
  if (folder.empty()) {
    throw ConfigError(kOwner, "folder", "not set; expected a folder of line files");
  }
  AnnotationFolder read(folder, stamps);
  if (!read.hasStamps()) {
    throw ConfigError(kOwner, "folder",
                      read.folder().string() +
                          ": which file belongs to which image is unknown: there is no stamps.txt "
                          "and 'stamps' is not set; it has a line 'stamp file' for every file, as "
                          "in TUM's lists");
  }
  times_ = findTimes(folder, read.folder());
  folder_ = std::move(read);
}

LineSegments RecordedDetector::detect(const Frame& frame) {
  if (!folder_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  const std::optional<std::string> name = folder_->nameAt(frame.stamp);
  if (!name) {
    throw Error(std::string(kOwner) + ": " + folder_->folder().string() +
                " has no entry within 0.001 s of " + formatStamp(frame.stamp) +
                " s (its stamps go " + "from " + formatStamp(*folder_->firstStamp()) + " to " +
                formatStamp(*folder_->lastStamp()) + ")");
  }
  const auto time = times_.find(*name);
  processing_time_ = time == times_.end() ? std::nullopt : std::make_optional(time->second);
  return *folder_->byName(*name);
}

}  // namespace evolin
