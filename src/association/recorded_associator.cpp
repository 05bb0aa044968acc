// Matches by stamp instead of by looks.
#include "evolin_ros/association/recorded_associator.h"

#include <algorithm>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "associator recorded";

}  // namespace

void RecordedAssociator::configure(const YAML::Node& parameters) {
  std::string folder;
  std::string stamps;
  ParameterReader reader(parameters, kOwner);
  reader.read("folder", &folder);
  reader.read("stamps", &stamps);
  reader.finish();
  if (folder.empty()) {
    throw ConfigError(kOwner, "folder", "not set; expected a folder of files of index pairs");
  }
  folder_.emplace(folder, stamps);
}

LineMatches RecordedAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!folder_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  const std::string frames =
      formatStamp(first.frame.stamp) + " and " + formatStamp(second.frame.stamp);
  const std::optional<IndexPairs> pairs = folder_->at(first.frame.stamp, second.frame.stamp);
  if (!pairs) {
    throw Error(std::string(kOwner) + ": " + folder_->folder().string() +
                " has no file for the frames at " + frames +
                " s, expected one for every pair (was it recorded at another frame step?)");
  }
  LineMatches matches;
  for (const auto& [i, j] : *pairs) {
    if (static_cast<std::size_t>(i) >= first.lines.size() ||
        static_cast<std::size_t>(j) >= second.lines.size()) {
      throw Error(std::string(kOwner) + ": frames at " + frames + " s: pair (" + std::to_string(i) +
                  ", " + std::to_string(j) + ") is beyond the " +
                  std::to_string(first.lines.size()) + " and " +
                  std::to_string(second.lines.size()) + " lines of these frames");
    }
    LineMatch match;
    match.first = static_cast<std::uint32_t>(i);
    match.second = static_cast<std::uint32_t>(j);
    matches.push_back(match);
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const LineMatch& a, const LineMatch& b) { return a.first < b.first; });
  return matches;
}

}  // namespace evolin
