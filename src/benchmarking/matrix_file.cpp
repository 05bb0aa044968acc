// The configuration of a benchmark in YAML: every refusal with its line.
#include <algorithm>

#include "config_file.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/yaml_file.h"
#include "evolin_ros/benchmarking/matrix.h"
#include "evolin_ros/evaluation/evaluation_settings.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

constexpr int kLargest = 1000000000;

/// Options of an input that go on as they are; those without a value apart.
const std::vector<const char*>& valueOptions() {
  static const std::vector<const char*> names = {
      "layout",      "camera",      "start",      "duration",          "pose_offset",
      "image_topic", "depth_topic", "pose_topic", "camera_info_topic", "ground_truth_topic",
      "world_frame", "depth_factor"};
  return names;
}

const std::vector<const char*>& pathOptions() {
  static const std::vector<const char*> names = {"ground_truth", "stamps"};
  return names;
}

const std::vector<const char*>& switchOptions() {
  static const std::vector<const char*> names = {"allow_missing", "same_rows"};
  return names;
}

std::string optionName(std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  return key;
}

class MatrixReader {
 public:
  MatrixReader(const fs::path& file, const fs::path& data)
      : file_(file.string()),
        config_(file_),
        data_(data.empty() ? fs::absolute(file).parent_path() : data) {}

  BenchmarkMatrix read() {
    const YAML::Node root = readYamlFile(file_);
    if (!root.IsMap()) {
      throw ParseError(file_, 0, "expected a map with sequences, detectors, associators, settings");
    }
    requireKnownKeys(root);
    evaluation_ = readEvaluation(root["evaluation"], "evaluation");
    for (const char* key : {"sequences", "detectors", "associators", "settings"}) {
      lists_.push_back(config_.list(root, key));
    }
    readSequences();
    readMethods("detector", lists_[1], &matrix_.detectors);
    readMethods("associator", lists_[2], &matrix_.associators);
    readSettings();
    expandCells(&matrix_);
    if (matrix_.cells.empty()) {
      throw ParseError(file_, 0, "has no cell: no setting and sequence have a metric in common");
    }
    return std::move(matrix_);
  }

 private:
  void requireKnownKeys(const YAML::Node& root) const {
    const std::vector<std::string> known = {"sequences", "detectors", "associators", "settings",
                                            "evaluation"};
    for (const auto& entry : root) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        throw config_.refusal(entry.first, quote(key) + " is unknown; did you mean '" +
                                               nearestWord(key, known) + "'?");
      }
    }
  }

  /// Names are told apart from those before.
  template <class Entry>
  std::string readName(const YAML::Node& node, const std::string& kind,
                       const std::vector<Entry>& before) const {
    const std::string name = config_.nameOf(node, kind);
    for (const Entry& entry : before) {
      if (entry.name == name) {
        throw config_.refusal(node, kind + ": 'name' is " + quote(name) + " as at " + entry.place +
                                        ", expected another one");
      }
    }
    return name;
  }

  MetricFamilies readMetrics(ParameterReader* reader, const std::string& owner) const {
    std::vector<std::string> names;
    for (const MetricFamily family : allMetricFamilies()) {
      names.push_back(toString(family));
    }
    const std::vector<std::string> known = names;
    reader->read("metrics", &names, known);
    if (names.empty()) {
      throw ConfigError(owner, "metrics", "got an empty list, expected at least one family");
    }
    MetricFamilies families;
    for (const std::string& name : names) {
      families.insert(parseMetricFamily(name));
    }
    return families;
  }

  YAML::Node readEvaluation(const YAML::Node& node, const std::string& owner) const {
    if (!node.IsDefined() || node.IsNull()) {
      return YAML::Node(YAML::NodeType::Map);
    }
    config_.walk(node, owner, [&](ParameterReader* reader) {
      if (node["metrics"].IsDefined()) {
        throw ConfigError(owner, "metrics",
                          "stands in an evaluation, expected in the setting or the sequence");
      }
      readEvaluationSettings(reader, owner, 0);
    });
    return YAML::Clone(node);
  }

  fs::path located(const std::string& path) const { return (data_ / path).lexically_normal(); }

  void readSequences() {
    for (const YAML::Node& node : lists_[0]) {
      BenchmarkSequence sequence;
      sequence.name = readName(node, "sequence", matrix_.sequences);
      sequence.place = config_.placeOf(node);
      const std::string owner = "sequence " + quote(sequence.name);
      if (!node.IsMap()) {
        throw config_.refusal(node, owner +
                                        ": expected a map with 'path', 'bags' or "
                                        "'synthetic'");
      }
      config_.walk(node, owner,
                   [&](ParameterReader* reader) { fillSequence(node, reader, &sequence); });
      matrix_.sequences.push_back(std::move(sequence));
    }
    if (matrix_.sequences.empty()) {
      throw ParseError(file_, 0, "'sequences' is empty, expected at least one");
    }
  }

  void fillSequence(const YAML::Node& node, ParameterReader* reader, BenchmarkSequence* sequence) {
    const std::string owner = "sequence " + quote(sequence->name);
    std::string path;
    std::vector<std::string> bags;
    reader->read("name", &sequence->name);
    reader->read("path", &path);
    reader->read("bags", &bags);
    const YAML::Node synthetic = reader->readMap("synthetic");
    sequence->metrics = readMetrics(reader, owner);
    if (!path.empty()) {
      bags.insert(bags.begin(), path);
    }
    for (const std::string& input : bags) {
      sequence->inputs.push_back(located(input));
    }
    const bool made = node["synthetic"].IsDefined();
    const int ways = int(!path.empty()) + int(bags.size() > (path.empty() ? 0 : 1)) + int(made);
    if (ways != 1) {
      throw ConfigError(owner, "", "expected one of 'path', 'bags' and 'synthetic'");
    }
    if (made) {
      sequence->synthetic = readSynthetic(synthetic, owner + ", synthetic");
      return;  // nothing else goes with it
    }
    readInputOptions(node, reader, sequence);
  }

  void readInputOptions(const YAML::Node& node, ParameterReader* reader,
                        BenchmarkSequence* sequence) const {
    for (const char* key : valueOptions()) {
      std::string value;
      reader->read(key, &value);
      const bool is_file = std::string(key) == "camera" && fs::path(value).has_extension();
      if (node[key].IsDefined()) {
        sequence->options.emplace_back(optionName(key), is_file ? located(value).string() : value);
      }
    }
    for (const char* key : pathOptions()) {
      std::string value;
      reader->read(key, &value);
      if (node[key].IsDefined()) {
        sequence->options.emplace_back(optionName(key), located(value).string());
      }
    }
    for (const char* key : switchOptions()) {
      bool value = false;
      reader->read(key, &value);
      if (value) {
        sequence->options.emplace_back(optionName(key), "");
      }
    }
  }

  synthetic::SyntheticOptions readSynthetic(const YAML::Node& node,
                                            const std::string& owner) const {
    synthetic::SyntheticOptions options;
    if (node.IsMap()) {
      config_.walk(node, owner, [&](ParameterReader* reader) {
        int seed = static_cast<int>(options.seed);
        reader->read("frames", &options.frames);
        reader->read("rate", &options.rate);
        reader->read("width", &options.width);
        reader->read("height", &options.height);
        reader->read("seed", &seed, 0, kLargest);
        reader->read("noise", &options.noise);
        reader->read("blur", &options.blur);
        options.seed = static_cast<std::uint64_t>(seed);
        synthetic::validate(options);
      });
    }
    return options;
  }

  void readMethods(const std::string& kind, const std::vector<YAML::Node>& nodes,
                   std::vector<BenchmarkMethod>* methods) {
    for (const YAML::Node& node : nodes) {
      BenchmarkMethod method;
      method.name = method.label = readName(node, kind, *methods);
      method.place = config_.placeOf(node);
      if (node.IsMap()) {
        config_.walk(node, kind + " " + quote(method.name),
                     [&](ParameterReader* reader) { fillMethod(kind, reader, &method); });
      } else {
        method.plugin = method.name;
      }
      methods->push_back(std::move(method));
    }
  }

  void fillMethod(const std::string& kind, ParameterReader* reader, BenchmarkMethod* method) {
    reader->read("name", &method->name);
    reader->read("label", &method->label);
    reader->read("recorded", &method->recorded);
    method->plugin = method->recorded.empty() ? method->name : "";
    reader->read("plugin", &method->plugin);
    const YAML::Node parameters = reader->readMap("parameters");
    if (parameters.IsMap()) {
      method->parameters = YAML::Clone(parameters);
    }
    if (!method->recorded.empty()) {
      method->recorded = located(method->recorded).string();
    }
    if (kind != "detector") {
      return;
    }
    const std::string owner = kind + " " + quote(method->name);
    method->evaluation = readEvaluation(reader->readMap("evaluation"), owner + ", evaluation");
    const YAML::Node thresholds = reader->readMap("score_thresholds");
    if (thresholds.IsMap()) {
      config_.walk(thresholds, owner + ", score_thresholds", [&](ParameterReader* inner) {
        const auto readThreshold = [&](const char* key, std::optional<double>* threshold) {
          double value = 0;
          inner->read(key, &value, LineSelection::kNoScoreThreshold, kLargest);
          if (thresholds[key].IsDefined()) {
            *threshold = value;
          }
        };
        readThreshold("repeatability", &method->repeatability_threshold);
        readThreshold("pose", &method->pose_threshold);
      });
    }
  }

  void readSettings() {
    std::vector<YAML::Node> nodes = lists_[3];
    if (nodes.empty()) {
      nodes.emplace_back("all");  // everything of everything
    }
    for (const YAML::Node& node : nodes) {
      BenchmarkSetting setting;
      setting.name = readName(node, "setting", matrix_.settings);
      setting.place = config_.placeOf(node);
      const std::string owner = "setting " + quote(setting.name);
      const YAML::Node map = node.IsMap() ? node : YAML::Node(YAML::NodeType::Map);
      config_.walk(map, owner,
                   [&](ParameterReader* reader) { fillSetting(map, reader, &setting); });
      matrix_.settings.push_back(std::move(setting));
    }
  }

  void fillSetting(const YAML::Node& node, ParameterReader* reader, BenchmarkSetting* setting) {
    const std::string owner = "setting " + quote(setting->name);
    std::string associate = "ground-truth";
    int max_lines = 0;
    reader->read("name", &setting->name);
    reader->read("associate", &associate, {"ground-truth", "detected"});
    reader->read("score_threshold", &setting->selection.score_threshold,
                 LineSelection::kNoScoreThreshold, kLargest);
    reader->read("min_length", &setting->selection.min_length, 0, kLargest);
    reader->read("max_lines", &max_lines, 0, kLargest);
    setting->associate_ground_truth = associate == "ground-truth";
    setting->selection.max_lines = static_cast<std::size_t>(max_lines);
    setting->metrics = readMetrics(reader, owner);
    setting->sequences = readPlaces(reader, owner, "sequences", matrix_.sequences);
    setting->detectors = readPlaces(reader, owner, "detectors", matrix_.detectors);
    setting->associators = readPlaces(reader, owner, "associators", matrix_.associators);
    setting->evaluation = YAML::Clone(evaluation_);
    const YAML::Node own = readEvaluation(reader->readMap("evaluation"), owner + ", evaluation");
    for (const auto& entry : own) {
      setting->evaluation[entry.first.Scalar()] = entry.second;
    }
    requireMethods(node, owner, setting);
  }

  /// Without methods, families that need them are left out where nobody named them.
  void requireMethods(const YAML::Node& node, const std::string& owner,
                      BenchmarkSetting* setting) const {
    for (const MetricFamily family : allMetricFamilies()) {
      const bool lines = needsDetector(family, setting->associate_ground_truth);
      const char* const lacking = lines && setting->detectors.empty() ? "detectors"
                                  : needsMatches(family) && setting->associators.empty()
                                      ? "associators"
                                      : nullptr;
      if (lacking == nullptr || setting->metrics.count(family) == 0) {
        continue;
      }
      if (node["metrics"].IsDefined()) {
        throw ConfigError(owner, lacking,
                          "is empty, but metrics has " + toString(family) + ", which needs one");
      }
      setting->metrics.erase(family);
    }
  }

  template <class Entry>
  std::vector<std::size_t> readPlaces(ParameterReader* reader, const std::string& owner,
                                      const std::string& key,
                                      const std::vector<Entry>& entries) const {
    std::vector<std::string> known;
    for (const Entry& entry : entries) {
      known.push_back(entry.name);
    }
    std::vector<std::string> wanted = known;
    reader->read(key, &wanted, known);
    if (known.empty() && !wanted.empty()) {
      throw ConfigError(owner, key, "names some, but the matrix has no " + key);
    }
    std::vector<std::size_t> places;
    for (const std::string& name : wanted) {
      const auto place =
          static_cast<std::size_t>(std::find(known.begin(), known.end(), name) - known.begin());
      if (std::find(places.begin(), places.end(), place) != places.end()) {
        throw ConfigError(owner, key, "has " + quote(name) + " twice, expected it once");
      }
      places.push_back(place);
    }
    std::sort(places.begin(), places.end());
    return places;
  }

  std::string file_;
  ConfigFile config_;
  fs::path data_;
  std::vector<std::vector<YAML::Node>> lists_;
  YAML::Node evaluation_;
  BenchmarkMatrix matrix_;
};

}  // namespace

BenchmarkMatrix readBenchmarkMatrix(const fs::path& file, const fs::path& data) {
  return MatrixReader(file, data).read();
}

}  // namespace evolin
