// Checked reading of one map of parameters.
#include "evolin_ros/base/parameters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

/// The value as a message shows it.
std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return quote(node.Scalar());
    case YAML::NodeType::Sequence:
      return node.size() == 0 ? "an empty list" : "a list";
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

/// "a number from 0 to 1", "a number of at least 0", "a number"; an end that does not limit is ""
/// on its side.
std::string withRange(const std::string& kind, const std::string& low, const std::string& high) {
  if (!low.empty() && !high.empty()) return kind + " from " + low + " to " + high;
  if (!low.empty()) return kind + " of at least " + low;
  if (!high.empty()) return kind + " of at most " + high;
  return kind;
}

/// YAML writes infinity and NaN with a leading point.
std::optional<double> parseYamlNumber(std::string text) {
  const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::string rest = text.substr(sign);
  for (const char* word : {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"}) {
    if (rest == word) {
      text.erase(sign, 1);
      break;
    }
  }
  return parseDouble(text);
}

std::size_t editDistance(std::string_view a, std::string_view b) {
  // One row of the table; row[j] is the distance of a's head to the first j characters of b.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

ParameterReader::ParameterReader(const YAML::Node& node, std::string owner)
    : owner_(std::move(owner)) {
  if (!node.IsDefined() || node.IsNull()) return;
  if (!node.IsMap()) {
    throw ConfigError(owner_, "", "expected a map of parameters, got " + shown(node));
  }
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      throw ConfigError(owner_, "", "expected names as keys, got " + shown(entry.first));
    }
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second) {
      throw ConfigError(owner_, key, "given twice; expected each parameter once");
    }
  }
  node_.reset(node);
}

YAML::Node ParameterReader::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

void ParameterReader::read(const std::string& key, bool* value) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  bool result = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, result)) {
    throw ConfigError(owner_, key,
                      "expected true or false (also yes, no, on, off), got " + shown(node));
  }
  *value = result;
}

int ParameterReader::wholeNumber(const std::string& key, const YAML::Node& node, int low,
                                 int high) const {
  const std::optional<std::int64_t> result =
      node.IsScalar() ? parseInteger(node.Scalar()) : std::nullopt;
  if (!result || *result < low || *result > high) {
    // Both ends stand in the message even where they are the type's own: it names why a whole
    // number may be refused.
    throw ConfigError(owner_, key,
                      "expected " +
                          withRange("a whole number", std::to_string(low), std::to_string(high)) +
                          ", got " + shown(node));
  }
  return static_cast<int>(*result);
}

void ParameterReader::read(const std::string& key, int* value, int low, int high) {
  const YAML::Node node = find(key);
  if (node.IsDefined()) *value = wholeNumber(key, node, low, high);
}

void ParameterReader::read(const std::string& key, std::vector<int>* values, int low, int high) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence() || node.size() == 0) {
    throw ConfigError(owner_, key, "expected a list of whole numbers, got " + shown(node));
  }
  values->clear();
  for (const YAML::Node& element : node) values->push_back(wholeNumber(key, element, low, high));
}

void ParameterReader::read(const std::string& key, double* value, double low, double high) {
  const YAML::Node node = find(key);
  if (node.IsDefined()) *value = number(key, node, low, high);
}

void ParameterReader::read(const std::string& key, std::vector<double>* values, double low,
                           double high, EmptyList empty) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence() || (node.size() == 0 && empty == EmptyList::kRefused)) {
    throw ConfigError(owner_, key, "expected a list of numbers, got " + shown(node));
  }
  values->clear();
  for (const YAML::Node& element : node) values->push_back(number(key, element, low, high));
}

void ParameterReader::read(const std::string& key, std::vector<std::string>* values,
                           const std::vector<std::string>& accepted) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) {
    throw ConfigError(owner_, key, "expected a list, got " + shown(node));
  }
  values->clear();
  for (const YAML::Node& element : node) values->push_back(word(key, element, accepted));
}

YAML::Node ParameterReader::readMap(const std::string& key) {
  const YAML::Node node = find(key);
  if (node.IsDefined() && !node.IsNull() && !node.IsMap()) {
    throw ConfigError(owner_, key, "expected a map, got " + shown(node));
  }
  return node.IsDefined() ? node : YAML::Node(YAML::NodeType::Null);
}

double ParameterReader::number(const std::string& key, const YAML::Node& node, double low,
                               double high) const {
  const std::optional<double> result =
      node.IsScalar() ? parseYamlNumber(node.Scalar()) : std::nullopt;
  // Written so that NaN fails.
  if (!result || !(*result >= low && *result <= high)) {
    throw ConfigError(owner_, key,
                      "expected " +
                          withRange("a number", std::isinf(low) ? "" : formatDouble(low),
                                    std::isinf(high) ? "" : formatDouble(high)) +
                          ", got " + shown(node));
  }
  return *result;
}

void ParameterReader::read(const std::string& key, std::string* value,
                           const std::vector<std::string>& accepted) {
  const YAML::Node node = find(key);
  if (node.IsDefined()) *value = word(key, node, accepted);
}

std::string ParameterReader::word(const std::string& key, const YAML::Node& node,
                                  const std::vector<std::string>& accepted) const {
  const std::string expected = accepted.empty() ? "text" : "one of " + joined(accepted);
  if (!node.IsScalar()) {
    throw ConfigError(owner_, key, "expected " + expected + ", got " + shown(node));
  }
  const std::string& text = node.Scalar();
  if (!accepted.empty() && std::find(accepted.begin(), accepted.end(), text) == accepted.end()) {
    throw ConfigError(owner_, key,
                      "expected " + expected + ", got " + shown(node) + "; did you mean '" +
                          nearestWord(text, accepted) + "'?");
  }
  return text;
}

void ParameterReader::finish() const {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    if (known_.empty()) throw ConfigError(owner_, key, "unknown; there are no parameters here");
    throw ConfigError(owner_, key,
                      "unknown; did you mean '" + nearestWord(key, known_) +
                          "'? Known parameters: " + joined(known_));
  }
}

std::string nearestWord(const std::string& word, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(word, candidate);
    if (nearest == nullptr || distance < least) {
      nearest = &candidate;
      least = distance;
    }
  }
  return nearest == nullptr ? std::string() : *nearest;
}

}  // namespace evolin
