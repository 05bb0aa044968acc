// `times.txt`: how long a method took for each file of a folder of its lines.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace evolin {

constexpr const char* kTimesFile = "times.txt";

/// Seconds by the line file's stem.
using ProcessingTimes = std::map<std::string, double>;

/// Lines "seconds stem"; lines that start with # and blank lines are skipped. Throws ParseError
/// with the line for a missing field, what is not a finite number of at least 0, or a stem given
/// twice.
ProcessingTimes readTimesFile(const std::filesystem::path& file);

/// Throws Error naming the file when it cannot be written.
void writeTimesFile(const std::filesystem::path& file, const ProcessingTimes& times);

}  // namespace evolin
