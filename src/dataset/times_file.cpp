// Reading and writing of times.txt.
#include "evolin_ros/dataset/times_file.h"

#include <cmath>
#include <optional>
#include <string_view>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

ProcessingTimes readTimesFile(const std::filesystem::path& file) {
  ProcessingTimes times;
  int line = 0;
  for (const std::string& row : readLines(file)) {
    ++line;
    const std::string_view text = trim(row);
    if (text.empty() || text.front() == '#') {
      continue;
    }
    const std::size_t end = text.find_first_of(" \t");
    const std::string_view stem = end == std::string_view::npos ? "" : trim(text.substr(end));
    if (stem.empty()) {
      throw ParseError(file.string(), line, "expected 'seconds name', got " + quote(text));
    }
    const std::optional<double> seconds = parseDouble(text.substr(0, end));
    if (!seconds || !std::isfinite(*seconds) || *seconds < 0) {
      throw ParseError(file.string(), line,
                       "expected seconds of at least 0, got " + quote(text.substr(0, end)));
    }
    if (!times.emplace(stem, *seconds).second) {
      throw ParseError(file.string(), line, quote(stem) + " is listed twice, expected it once");
    }
  }
  return times;
}

void writeTimesFile(const std::filesystem::path& file, const ProcessingTimes& times) {
  std::string content = "# seconds name\n";
  for (const auto& [stem, seconds] : times) {
    content += formatDouble(seconds) + " " + stem + "\n";
  }
  writeFileAtomically(file, content);
}

}  // namespace evolin
