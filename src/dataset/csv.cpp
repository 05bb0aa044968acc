// Reading and writing of the benchmark's CSV files.
#include "evolin_ros/dataset/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// Whole numbers up to here are exact as floating point.
constexpr double kLargestExactWhole = 9007199254740992.0;

/// The lines of the file up to the last one that is not blank.
std::vector<std::string> readRows(const std::filesystem::path& file) {
  std::vector<std::string> rows = readLines(file);
  while (!rows.empty() && trim(rows.back()).empty()) rows.pop_back();
  return rows;
}

int lineNumber(std::size_t row) { return static_cast<int>(row) + 1; }

/// The fields of one row, as many as `Columns`; `names` says what they are in the message.
template <std::size_t Columns>
std::array<std::string_view, Columns> splitRow(const std::filesystem::path& file, std::size_t row,
                                               std::string_view text, const std::string& names) {
  std::array<std::string_view, Columns> fields;
  std::size_t count = 0;
  std::string_view rest = trim(text);
  const bool blank = rest.empty();
  while (!blank) {
    const std::size_t end = rest.find(',');
    if (count < Columns) fields[count] = rest.substr(0, end);
    ++count;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (count != Columns) {
    throw ParseError(file.string(), lineNumber(row),
                     "expected " + std::to_string(Columns) + " column(s) " + names + ", got " +
                         (blank ? "a blank row" : std::to_string(count) + " in " + quote(text)));
  }
  return fields;
}

double readFinite(const std::filesystem::path& file, std::size_t row, std::string_view field,
                  const std::string& name) {
  const std::optional<double> value = parseDouble(field);
  if (!value || !std::isfinite(*value)) {
    throw ParseError(file.string(), lineNumber(row),
                     "expected a finite number as " + name + ", got " + quote(field));
  }
  return *value;
}

std::int64_t readIndex(const std::filesystem::path& file, std::size_t row, std::string_view field,
                       const std::string& name) {
  std::optional<std::int64_t> value = parseInteger(field);
  if (!value) {
    const std::optional<double> number = parseDouble(field);
    if (number && std::fabs(*number) <= kLargestExactWhole && std::floor(*number) == *number) {
      value = static_cast<std::int64_t>(*number);
    }
  }
  if (!value || *value < 0) {
    throw ParseError(file.string(), lineNumber(row),
                     "expected a whole number >= 0 as " + name + ", got " + quote(field));
  }
  return *value;
}

/// One field of a file to write: what its reader would refuse is refused here.
std::string writtenField(const std::filesystem::path& file, std::size_t row, double value,
                         const std::string& name) {
  if (!std::isfinite(value)) {
    throw Error(file.string() + ": cannot be written: " + name + " of line " + std::to_string(row) +
                " is " + formatDouble(value) + ", expected a finite number");
  }
  return formatDouble(value);
}

std::string lowerCase(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace

LineSegments readLinesCsv(const std::filesystem::path& file) {
  const std::vector<std::string> rows = readRows(file);
  LineSegments lines;
  lines.reserve(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto fields = splitRow<4>(file, row, rows[row], "x1,y1,x2,y2");
    LineSegment line;
    line.x1 = readFinite(file, row, fields[0], "x1");
    line.y1 = readFinite(file, row, fields[1], "y1");
    line.x2 = readFinite(file, row, fields[2], "x2");
    line.y2 = readFinite(file, row, fields[3], "y2");
    lines.push_back(line);
  }
  return lines;
}

std::vector<double> readScoresCsv(const std::filesystem::path& file) {
  const std::vector<std::string> rows = readRows(file);
  std::vector<double> scores;
  scores.reserve(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    scores.push_back(readFinite(file, row, splitRow<1>(file, row, rows[row], "score")[0], "score"));
  }
  return scores;
}

IndexPairs readIndexPairsCsv(const std::filesystem::path& file) {
  const std::vector<std::string> rows = readRows(file);
  IndexPairs pairs;
  pairs.reserve(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto fields = splitRow<2>(file, row, rows[row], "i,j");
    pairs.emplace_back(readIndex(file, row, fields[0], "i"), readIndex(file, row, fields[1], "j"));
  }
  return pairs;
}

LineSegments readScoredLinesCsv(const std::filesystem::path& lines,
                                const std::filesystem::path& scores) {
  LineSegments result = readLinesCsv(lines);
  const std::vector<double> values = readScoresCsv(scores);
  if (values.size() != result.size()) {
    throw ParseError(scores.string(), 0,
                     "has " + std::to_string(values.size()) + " score(s), expected " +
                         std::to_string(result.size()) + ", one for each line of " +
                         lines.string());
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i].score = values[i];
  return result;
}

void writeLinesCsv(const std::filesystem::path& file, const LineSegments& lines) {
  std::string content;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    content += writtenField(file, row, line.x1, "x1") + ",";
    content += writtenField(file, row, line.y1, "y1") + ",";
    content += writtenField(file, row, line.x2, "x2") + ",";
    content += writtenField(file, row, line.y2, "y2") + "\n";
  }
  writeFileAtomically(file, content);
}

void writeScoresCsv(const std::filesystem::path& file, const LineSegments& lines) {
  std::string content;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    content += writtenField(file, row, lines[row].score, "score") + "\n";
  }
  writeFileAtomically(file, content);
}

std::vector<double> readNumbers(const std::filesystem::path& file) {
  const std::vector<std::string> rows = readLines(file);
  std::vector<double> numbers;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const std::string_view word : splitWords(trim(rows[row]))) {
      const std::optional<double> value = parseDouble(word);
      if (!value || std::isnan(*value)) {
        throw ParseError(file.string(), lineNumber(row),
                         "expected numbers separated by white space, got " + quote(word));
      }
      numbers.push_back(*value);
    }
  }
  if (numbers.empty()) {
    throw ParseError(file.string(), 0, "is empty, expected numbers separated by white space");
  }
  return numbers;
}

std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::vector<std::string>& extensions) {
  std::string wanted;
  for (const std::string& extension : extensions) {
    wanted += (wanted.empty() ? "" : " or ") + extension;
  }
  std::error_code reason;
  if (!std::filesystem::is_directory(folder, reason)) {
    throw Error(folder.string() + ": is no folder, expected one with files " + wanted);
  }
  std::vector<std::filesystem::path> files;
  std::filesystem::directory_iterator at(folder, reason);
  for (; !reason && at != std::filesystem::directory_iterator(); at.increment(reason)) {
    const std::filesystem::path& path = at->path();
    const std::string name = path.filename().string();
    const std::string extension = lowerCase(path.extension().string());
    const bool matches =
        std::any_of(extensions.begin(), extensions.end(),
                    [&](const std::string& each) { return lowerCase(each) == extension; });
    // Hidden files are leftovers of interrupted writers and a desktop's own notes, no data.
    if (!matches || name.front() == '.') continue;
    // A folder of that name is passed over; a broken link stays, so that its reader complains.
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored)) files.push_back(path);
  }
  if (reason) throw Error(folder.string() + ": cannot be listed: " + reason.message());
  if (files.empty()) throw Error(folder.string() + ": has no file " + wanted);
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace evolin
