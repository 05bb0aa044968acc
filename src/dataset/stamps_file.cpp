// Reading, writing and searching of stamps.txt.
#include "evolin_ros/dataset/stamps_file.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// |a - b| of two stamps, which may be further apart than a stamp can say.
std::uint64_t gap(Stamp a, Stamp b) {
  const std::uint64_t difference = static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
  return a >= b ? difference : 0 - difference;
}

/// "stamp file"; the file name is all that follows the stamp, spaces inside included.
StampedFile parseEntry(const std::string& file, int line, std::string_view text) {
  const std::size_t end = text.find_first_of(" \t");
  const std::string_view name = end == std::string_view::npos ? "" : trim(text.substr(end));
  if (name.empty()) {
    throw ParseError(file, line, "expected 'stamp file', got " + quote(text));
  }
  const std::optional<Stamp> stamp = parseStamp(text.substr(0, end));
  if (!stamp) {
    throw ParseError(file, line,
                     "expected a stamp in decimal seconds, got " + quote(text.substr(0, end)));
  }
  if (name.find('\0') != std::string_view::npos) {
    throw ParseError(file, line, "expected the name of a file, got " + quote(name));
  }
  return {*stamp, std::string(name)};
}

}  // namespace

std::vector<StampedFile> readStampsFile(const std::filesystem::path& file) {
  std::vector<StampedFile> entries;
  int line = 0;
  for (const std::string& row : readLines(file)) {
    ++line;
    const std::string_view text = trim(row);
    if (text.empty() || text.front() == '#') continue;
    StampedFile entry = parseEntry(file.string(), line, text);
    if (!entries.empty() && entry.stamp <= entries.back().stamp) {
      throw ParseError(file.string(), line,
                       "stamp " + formatStamp(entry.stamp) + " is not after the one before, " +
                           formatStamp(entries.back().stamp) + "; expected increasing stamps");
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

void writeStampsFile(const std::filesystem::path& file, const std::vector<StampedFile>& entries) {
  std::string content = "# stamp file\n";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const StampedFile& entry = entries[i];
    const std::string at = file.string() + ": cannot be written: entry " + std::to_string(i);
    if (i > 0 && entry.stamp <= entries[i - 1].stamp) {
      throw Error(at + " has stamp " + formatStamp(entry.stamp) + ", expected one after " +
                  formatStamp(entries[i - 1].stamp));
    }
    // Such a name would come back as another one.
    if (entry.file.empty() || trim(entry.file) != entry.file ||
        entry.file.find_first_of(std::string_view("\n\0", 2)) != std::string::npos) {
      throw Error(at + " has the file name " + quote(entry.file) +
                  ", expected one without line ends and surrounding spaces");
    }
    content += formatStamp(entry.stamp) + " " + entry.file + "\n";
  }
  writeFileAtomically(file, content);
}

const StampedFile* findNearest(const std::vector<StampedFile>& entries, Stamp stamp,
                               Stamp tolerance) {
  if (tolerance < 0) return nullptr;
  const auto after =
      std::lower_bound(entries.begin(), entries.end(), stamp,
                       [](const StampedFile& entry, Stamp value) { return entry.stamp < value; });
  const StampedFile* nearest = after == entries.end() ? nullptr : &*after;
  if (after != entries.begin()) {
    const StampedFile* before = &*(after - 1);
    // The earlier one where both are as near.
    if (nearest == nullptr || gap(before->stamp, stamp) <= gap(nearest->stamp, stamp)) {
      nearest = before;
    }
  }
  const bool near =
      nearest != nullptr && gap(nearest->stamp, stamp) <= static_cast<std::uint64_t>(tolerance);
  return near ? nearest : nullptr;
}

}  // namespace evolin
