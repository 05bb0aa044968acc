// `stamps.txt`: which file of a folder belongs to which time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evolin_ros/base/stamp.h"

namespace evolin {

struct StampedFile {
  Stamp stamp = 0;
  std::string file;  ///< as written, relative to the list's folder
};

/// Lines "stamp file" as in TUM's lists; lines that start with # and blank lines are skipped.
/// Throws ParseError with the line for a missing field, a malformed stamp, or stamps that do not
/// increase.
std::vector<StampedFile> readStampsFile(const std::filesystem::path& file);

void writeStampsFile(const std::filesystem::path& file, const std::vector<StampedFile>& entries);

/// The entry nearest to `stamp` within `tolerance` (both in ns), or nullptr; `entries` in
/// increasing order.
const StampedFile* findNearest(const std::vector<StampedFile>& entries, Stamp stamp,
                               Stamp tolerance);

}  // namespace evolin
