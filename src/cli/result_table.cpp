// Groups entries that depend on the same things into rows, and aligns columns.
#include "result_table.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "evolin_ros/base/text.h"

namespace evolin::cli {

namespace {

using Row = std::vector<std::string>;

std::string optionalNumber(const std::optional<double>& value) {
  return value ? formatDouble(*value) : "";
}

/// What an entry depends on, as texts under kKeyHeads.
Row keyOf(const PublishedEntry& entry) {
  return {entry.distance.value_or(""), optionalNumber(entry.distance_threshold),
          optionalNumber(entry.score_threshold),
          entry.frames_step ? std::to_string(*entry.frames_step) : "",
          optionalNumber(entry.threshold)};
}

const Row& keyHeads() {
  static const Row kKeyHeads = {"distance", "distance_threshold", "score_threshold", "step",
                                "threshold"};
  return kKeyHeads;
}

std::string fourDecimals(double value) {
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof(text), "%.4f", value);
  return text;
}

std::string cell(const PublishedEntry& entry) {
  if (!entry.undefined.empty()) {
    return "-";
  }
  std::string text = fourDecimals(std::get<double>(entry.value));
  if (entry.confidence_interval) {
    text += " [" + fourDecimals(entry.confidence_interval->low) + ", " +
            fourDecimals(entry.confidence_interval->high) + "]";
  }
  return text;
}

std::string align(const std::vector<Row>& rows, std::size_t left_columns) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      widths[column] = std::max(widths[column], row[column].size());
    }
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t column = 0; column < row.size(); ++column) {
      const std::string padding(widths[column] - row[column].size(), ' ');
      line += (column > 0 ? "  " : "");
      line += column < left_columns ? row[column] + padding : padding + row[column];
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

/// "no value for precision, fscore: no lines were detected", a line a reason.
std::string reasonsBelow(const std::vector<PublishedEntry>& entries) {
  std::vector<std::pair<std::string, Row>> reasons;  // each with the names of its figures
  for (const PublishedEntry& entry : entries) {
    if (entry.undefined.empty() || !std::holds_alternative<double>(entry.value)) {
      continue;
    }
    auto reason = std::find_if(reasons.begin(), reasons.end(), [&entry](const auto& known) {
      return known.first == entry.undefined;
    });
    if (reason == reasons.end()) {
      reason = reasons.insert(reasons.end(), {entry.undefined, {}});
    }
    Row& names = reason->second;
    if (std::find(names.begin(), names.end(), entry.name) == names.end()) {
      names.push_back(entry.name);
    }
  }
  std::string text;
  for (const auto& [reason, names] : reasons) {
    text += "no value for ";
    for (std::size_t index = 0; index < names.size(); ++index) {
      text += (index > 0 ? ", " : "") + names[index];
    }
    text += ": " + reason + '\n';
  }
  return text;
}

}  // namespace

std::string toTable(const std::vector<PublishedEntry>& entries) {
  std::vector<std::string> names;
  std::vector<std::pair<Row, Row>> rows;  // what it depends on; a value a name
  for (const PublishedEntry& entry : entries) {
    if (!std::holds_alternative<double>(entry.value)) {
      continue;
    }
    const auto name = std::find(names.begin(), names.end(), entry.name);
    const auto column = static_cast<std::size_t>(name - names.begin());
    if (name == names.end()) {
      names.push_back(entry.name);
    }
    const Row key = keyOf(entry);
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&key](const auto& candidate) { return candidate.first == key; });
    if (row == rows.end()) {
      row = rows.insert(rows.end(), {key, {}});
    }
    row->second.resize(std::max(row->second.size(), column + 1));
    row->second[column] = cell(entry);
  }
  // Only the heads that some row fills.
  std::vector<std::size_t> used;
  for (std::size_t head = 0; head < keyHeads().size(); ++head) {
    if (std::any_of(rows.begin(), rows.end(),
                    [head](const auto& row) { return !row.first[head].empty(); })) {
      used.push_back(head);
    }
  }
  std::vector<Row> table(1);
  for (const std::size_t head : used) {
    table[0].push_back(keyHeads()[head]);
  }
  table[0].insert(table[0].end(), names.begin(), names.end());
  for (auto& [key, values] : rows) {
    Row line;
    for (const std::size_t head : used) {
      line.push_back(key[head].empty() ? "-" : key[head]);
    }
    values.resize(names.size());
    std::replace(values.begin(), values.end(), std::string(), std::string("-"));
    line.insert(line.end(), values.begin(), values.end());
    table.push_back(line);
  }
  return align(table, !used.empty() && used.front() == 0 ? 1 : 0) + reasonsBelow(entries);
}

std::string toCsv(const std::vector<PublishedEntry>& entries) {
  std::string text = "name";
  for (const std::string& head : keyHeads()) {
    text += "," + head;
  }
  text += ",value,low,high,reason\n";
  for (const PublishedEntry& entry : entries) {
    const double* value = std::get_if<double>(&entry.value);
    if (value == nullptr) {
      continue;
    }
    text += entry.name;
    for (const std::string& key : keyOf(entry)) {
      text += "," + key;
    }
    const bool defined = entry.undefined.empty();
    text += "," + (defined ? formatDouble(*value) : "") + ",";
    if (defined && entry.confidence_interval) {
      text += formatDouble(entry.confidence_interval->low) + "," +
              formatDouble(entry.confidence_interval->high);
    } else {
      text += ",";
    }
    text += "," + entry.undefined + '\n';
  }
  return text;
}

}  // namespace evolin::cli
