// Reads a plug-in's parameters from YAML and refuses unknown keys, wrong types and values out of
// range by name.
#pragma once

#include <yaml-cpp/yaml.h>

#include <limits>
#include <string>
#include <vector>

namespace evolin {

/// Walks over one YAML map. Call read() for every parameter that exists, then finish(), which
/// refuses what nobody read and names the nearest known key. An undefined or null node is an empty
/// map. All errors are ConfigError.
class ParameterReader {
 public:
  enum class EmptyList { kRefused, kAccepted };

  /// `owner` stands at the head of every message, for example "detector opencv_lsd".
  ParameterReader(const YAML::Node& node, std::string owner);

  /// Leave `*value` alone when the key is absent; the accepted range is inclusive.
  void read(const std::string& key, bool* value);
  void read(const std::string& key, int* value, int low = std::numeric_limits<int>::min(),
            int high = std::numeric_limits<int>::max());
  void read(const std::string& key, double* value,
            double low = -std::numeric_limits<double>::infinity(),
            double high = std::numeric_limits<double>::infinity());
  void read(const std::string& key, std::string* value,
            const std::vector<std::string>& accepted = {});

  /// A list of numbers, each within the range; of at least one unless `empty` is accepted.
  void read(const std::string& key, std::vector<double>* values,
            double low = -std::numeric_limits<double>::infinity(),
            double high = std::numeric_limits<double>::infinity(),
            EmptyList empty = EmptyList::kRefused);
  void read(const std::string& key, std::vector<int>* values, int low, int high);
  void read(const std::string& key, std::vector<std::string>* values,
            const std::vector<std::string>& accepted = {});

  /// A map for another reader; a null node when the key is absent.
  YAML::Node readMap(const std::string& key);

  void finish() const;

 private:
  YAML::Node find(const std::string& key);
  int wholeNumber(const std::string& key, const YAML::Node& node, int low, int high) const;
  double number(const std::string& key, const YAML::Node& node, double low, double high) const;
  std::string word(const std::string& key, const YAML::Node& node,
                   const std::vector<std::string>& accepted) const;

  YAML::Node node_;
  std::string owner_;
  std::vector<std::string> known_;
};

/// The entry of `known` with the smallest edit distance to `word`, or "" when `known` is empty.
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

}  // namespace evolin
