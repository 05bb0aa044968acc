// Reading the list of network files and looking for them.
#include "evolin_ros/inference/model_catalogue.h"

#include <algorithm>
#include <set>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/yaml_file.h"
#include "evolin_ros/inference/model_files.h"
#include "evolin_ros/inference/onnx_file.h"

namespace evolin {
namespace {

void require(bool holds, const std::filesystem::path& file, const std::string& message) {
  if (!holds) {
    throw ParseError(file.string(), 0, message);
  }
}

bool isDigest(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

ModelEntry readEntry(const YAML::Node& node, const std::string& where) {
  ModelEntry entry;
  ParameterReader reader(node, where);
  reader.read("name", &entry.name);
  reader.read("method", &entry.method);
  reader.read("title", &entry.title);
  reader.read("repository", &entry.repository);
  reader.read("licence", &entry.licence);
  reader.read("file", &entry.file);
  reader.read("sha256", &entry.sha256);
  reader.read("get", &entry.get);
  reader.read("input", &entry.input);
  reader.read("evolin", &entry.evolin);
  reader.read("authors", &entry.authors);
  reader.finish();
  return entry;
}

}  // namespace

std::vector<ModelEntry> readModelCatalogue(const std::filesystem::path& file) {
  const YAML::Node root = readYamlFile(file);
  require(root.IsMap() && root["models"].IsDefined() && root["models"].IsSequence(), file,
          "expected a list 'models'");
  std::vector<ModelEntry> entries;
  std::set<std::string> files;
  std::set<std::string> names;
  for (const YAML::Node& node : root["models"]) {
    const std::string where = "model " + std::to_string(entries.size() + 1);
    ModelEntry entry;
    try {
      entry = readEntry(node, where);
    } catch (const ConfigError& error) {
      throw ParseError(file.string(), 0, error.what());
    }
    const bool complete = !entry.name.empty() && !entry.title.empty() &&
                          !entry.repository.empty() && !entry.licence.empty() &&
                          !entry.file.empty() && !entry.get.empty();
    require(complete, file,
            where + ": expected name, title, repository, licence, file and get, none empty");
    require(entry.sha256.empty() || isDigest(entry.sha256), file,
            where + ": sha256 is " + quote(entry.sha256) +
                ", expected 64 hexadecimal digits in lower case, or \"\"");
    require(entry.file.find('/') == std::string::npos, file,
            where + ": file is " + quote(entry.file) + ", expected a name without folder");
    require(
        files.insert(entry.file).second && names.insert(entry.name).second, file,
        where + ": " + quote(entry.name) + " or its file " + quote(entry.file) + " occurs twice");
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string toString(ModelState state) {
  switch (state) {
    case ModelState::kPresent:
      return "present";
    case ModelState::kUnknown:
      return "present, sum unknown";
    case ModelState::kAbsent:
      return "absent";
    case ModelState::kWrongSum:
      return "wrong sum";
    case ModelState::kDamaged:
      return "damaged";
  }
  return "";
}

ModelStatus statusOf(const ModelEntry& entry) {
  const auto file = findModelFile(entry.file);
  if (!file) {
    return {ModelState::kAbsent, {}, ""};
  }
  try {
    const OnnxFile onnx = readOnnxFile(*file);
    if (!entry.sha256.empty()) {
      return {onnx.digest == entry.sha256 ? ModelState::kPresent : ModelState::kWrongSum, *file,
              onnx.digest};
    }
    if (onnx.recorded_digest.empty()) {
      return {ModelState::kUnknown, *file, onnx.digest};
    }
    return {onnx.isAsRecorded() ? ModelState::kPresent : ModelState::kWrongSum, *file, onnx.digest};
  } catch (const ParseError& error) {
    return {ModelState::kDamaged, *file, error.what()};
  }
}

}  // namespace evolin
