// Digests are of JSON texts with sorted keys.
#include "benchmark_plan.h"

#include <map>
#include <memory>
#include <utility>

#include "child_process.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/benchmarking/digest_cache.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/inference/model_catalogue.h"
#include "evolin_ros/inference/model_files.h"
#include "options.h"
#include "package_files.h"
#include "plan_json.h"
#include "plugin_loader.h"
#include "synthetic_folder.h"
#include "yaml_json.h"

namespace evolin::cli {

namespace fs = std::filesystem;
using Json = nlohmann::json;  // sorts its keys

namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

class Planner {
 public:
  Planner(const BenchmarkMatrix& matrix, const fs::path& root)
      : matrix_(matrix),
        root_(root),
        digests_(root.empty() ? fs::path() : root / "digests.txt"),
        program_({{"version", programVersion()}, {"files", digests_.digestOf(programFiles())}}) {}

  BenchmarkPlan plan() {
    for (const BenchmarkSequence& sequence : matrix_.sequences) {
      plan_.sequences.push_back(look(sequence));
    }
    for (const BenchmarkCell& cell : matrix_.cells) {
      plan_.cells.push_back(look(cell));
    }
    if (!root_.empty()) {
      digests_.save();
    }
    return std::move(plan_);
  }

 private:
  /// A plug-in as it would be used.
  struct Method {
    std::string unavailable;
    Json content;
  };

  PlannedSequence look(const BenchmarkSequence& sequence) {
    if (sequence.synthetic) {
      return {"", digestOfText(describeSequence(*sequence.synthetic))};
    }
    for (const fs::path& input : sequence.inputs) {
      if (!fs::exists(input)) {
        return {"sequence " + sequence.name + ": " + input.string() + " is not there", ""};
      }
    }
    RecordingInput checked;
    try {
      setInput(sequence, root_, &checked);
    } catch (const UsageError& error) {
      throw Error(sequence.place + ": sequence " + quote(sequence.name) + ": " + error.what());
    }
    try {
      return {"", digestOf(sequence)};
    } catch (const Error& error) {
      return {"sequence " + sequence.name + ": " + error.what(), ""};
    }
  }

  std::string digestOf(const BenchmarkSequence& sequence) {
    std::vector<fs::path> places = sequence.inputs;
    Json options = Json::object();
    for (const auto& [name, value] : sequence.options) {
      const bool is_path = name == "ground-truth" || name == "stamps";
      if (is_path) {
        places.emplace_back(value);
      } else if (name == "camera") {
        places.push_back(cameraFileOf(value, cameraFolder()));
      }
      options[name] = is_path || name == "camera" ? "" : value;
    }
    return digestOfText(options.dump() + digests_.digestOf(places));
  }

  PlannedCell look(const BenchmarkCell& cell) {
    const BenchmarkSequence& sequence = matrix_.sequences[cell.sequence];
    PlannedCell planned;
    planned.unavailable = plan_.sequences[cell.sequence].unavailable;
    Json content = {{"program", program_},
                    {"sequence", plan_.sequences[cell.sequence].digest},
                    {"evaluation", toJson(cell.evaluation)}};
    if (cell.detector && planned.unavailable.empty()) {
      content["detector"] = chooseDetector(cell, &planned);
      content["selection"] = {cell.selection.score_threshold, cell.selection.min_length,
                              cell.selection.max_lines};
    }
    if (cell.associator && planned.unavailable.empty()) {
      const BenchmarkMethod& method = matrix_.associators[*cell.associator];
      const std::string folder = replaced(replaced(method.recorded, "{sequence}", sequence.name),
                                          "{detector}", detectorName(matrix_, cell));
      content["associator"] =
          choose(method, associator(*cell.associator), folder, &planned.matches_folder, &planned);
      content["associate"] = matrix_.settings[cell.setting].associate_ground_truth;
    }
    if (planned.unavailable.empty()) {
      planned.content_hash = digestOfText(content.dump());
    }
    return planned;
  }

  Json chooseDetector(const BenchmarkCell& cell, PlannedCell* planned) {
    const BenchmarkSequence& sequence = matrix_.sequences[cell.sequence];
    const BenchmarkMethod& method = matrix_.detectors[*cell.detector];
    const std::string folder = replaced(method.recorded, "{sequence}", sequence.name);
    Json content =
        choose(method, detector(*cell.detector), folder, &planned->lines_folder, planned);
    if (planned->unavailable.empty() && planned->lines_folder.empty()) {
      planned->detection = detectionOf(cell, content);
    }
    return content;
  }

  /// The plug-in where it is available, else what was recorded of it.
  Json choose(const BenchmarkMethod& method, const Method& plugin, const std::string& recorded,
              std::string* folder, PlannedCell* planned) {
    if (plugin.unavailable.empty()) {
      return plugin.content;
    }
    if (!recorded.empty() && fs::exists(recorded)) {
      *folder = recorded;
      return {{"recorded", digests_.digestOf(std::vector<fs::path>{recorded})},
              {"parameters", toJson(method.parameters)}};
    }
    planned->unavailable = plugin.unavailable;
    if (!recorded.empty()) {
      planned->unavailable += "; recorded: " + recorded + " is not there";
    }
    return nullptr;
  }

  std::size_t detectionOf(const BenchmarkCell& cell, const Json& content) {
    const auto [entry, is_new] =
        detections_.try_emplace({cell.sequence, *cell.detector}, plan_.detections.size());
    if (is_new) {
      PlannedDetection detection;
      detection.id = matrix_.sequences[cell.sequence].name + "--" + detectorName(matrix_, cell);
      detection.sequence = cell.sequence;
      detection.detector = *cell.detector;
      detection.content_hash = digestOfText(Json{
          {"program", program_},
          {"sequence", plan_.sequences[cell.sequence].digest},
          {"detector", content}}.dump());
      plan_.detections.push_back(std::move(detection));
    }
    return entry->second;
  }

  const Method& detector(std::size_t place) {
    return known(matrix_.detectors[place], &detectors_, [this](const BenchmarkMethod& method) {
      const auto plugin = loader_->loadDetector(method.plugin);
      return std::make_pair(plugin, loader_->detectorLibrary(method.plugin));
    });
  }

  const Method& associator(std::size_t place) {
    return known(matrix_.associators[place], &associators_, [this](const BenchmarkMethod& method) {
      const auto plugin = loader_->loadAssociator(method.plugin);
      return std::make_pair(plugin, loader_->associatorLibrary(method.plugin));
    });
  }

  /// Looked at once. `load` gives a plug-in and its library.
  template <class Load>
  const Method& known(const BenchmarkMethod& method, std::map<std::string, Method>* methods,
                      const Load& load) {
    const auto [entry, is_new] = methods->try_emplace(method.name);
    if (is_new) {
      entry->second = look(method, load);
    }
    return entry->second;
  }

  template <class Load>
  Method look(const BenchmarkMethod& method, const Load& load) {
    if (method.plugin.empty()) {
      return {method.name + " is no plug-in of this build", nullptr};
    }
    if (!loader_) {
      loader_ = std::make_unique<PluginLoader>();
    }
    try {
      const auto [plugin, library] = load(method);
      const std::string why = plugin->whyUnavailable();
      if (!why.empty()) {
        return {why, nullptr};
      }
      plugin->configure(method.parameters);
      return {"",
              {{"plugin", method.plugin},
               {"parameters", toJson(method.parameters)},
               {"library", digests_.digestOf(library)},
               {"networks", networksOf(method)}}};
    } catch (const ConfigError& error) {
      throw Error(method.place + ": " + error.what());
    } catch (const Error& error) {
      return {error.what(), nullptr};
    }
  }

  /// Digests of the network files that the method may run: the one that its parameters name, else
  /// all that the catalogue has for it, as its default is among them. Those of them that are here.
  Json networksOf(const BenchmarkMethod& method) {
    std::vector<std::string> files;
    const YAML::Node model = method.parameters["model"];
    if (model.IsDefined() && model.IsScalar()) {
      files.push_back(model.Scalar());
    } else {
      if (!catalogue_) {
        catalogue_ = readModelCatalogue(modelCatalogueFile());
      }
      for (const ModelEntry& entry : *catalogue_) {
        if (entry.method == method.plugin) {
          files.push_back(entry.file);
        }
      }
    }
    Json digests = Json::array();
    for (const std::string& name : files) {
      if (const std::optional<fs::path> file = findModelFile(name)) {
        digests.push_back(digests_.digestOf(*file));
      }
    }
    return digests;
  }

  const BenchmarkMatrix& matrix_;
  fs::path root_;
  DigestCache digests_;
  Json program_;
  std::unique_ptr<PluginLoader> loader_;
  std::optional<std::vector<ModelEntry>> catalogue_;
  std::map<std::string, Method> detectors_;
  std::map<std::string, Method> associators_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> detections_;
  BenchmarkPlan plan_;
};

}  // namespace

fs::path sequenceFolder(const fs::path& root, const std::string& name) {
  return root / "sequences" / name;
}

fs::path detectionFolder(const fs::path& root, const std::string& id) {
  return root / "detections" / id;
}

fs::path cellFolder(const fs::path& root, const std::string& id) { return root / "cells" / id; }

void setInput(const BenchmarkSequence& sequence, const fs::path& root, RecordingInput* input) {
  std::vector<std::string> arguments;
  const auto add = [&arguments](const std::string& name, const std::string& value) {
    arguments.push_back(value.empty() ? "--" + name : "--" + name + "=" + value);
  };
  if (sequence.synthetic) {
    add("input", sequenceFolder(root, sequence.name).string());
    add("layout", "evolin");
  }
  for (const fs::path& path : sequence.inputs) {
    add("input", path.string());
  }
  for (const auto& [name, value] : sequence.options) {
    add(name, value);
  }
  boost::program_options::variables_map given;
  parseOptions("", input->describe(), arguments, &given);
  input->check(given);
}

BenchmarkPlan makePlan(const BenchmarkMatrix& matrix, const fs::path& root) {
  const ChildResult result = runInChild([&] { return planToJson(Planner(matrix, root).plan()); });
  if (!result.done) {
    throw Error(result.text);
  }
  return planFromJson(result.text);
}

}  // namespace evolin::cli
