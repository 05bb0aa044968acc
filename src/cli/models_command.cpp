// `evolin models`.
#include "models_command.h"

#include <algorithm>
#include <boost/program_options/options_description.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "evolin_ros/inference/model_catalogue.h"
#include "evolin_ros/inference/model_files.h"
#include "evolin_ros/inference/network.h"
#include "options.h"
#include "package_files.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Lists the network files of learned methods: present, absent, or with a wrong sum; where they "
    "come from, under which licence, and how to get them. Looked for in the folders of "
    "EVOLIN_MODELS (separated by ':') and in ~/.ros/evolin_ros/models.\n\n"
    "Usage: evolin models [--all] [--format table|json]";

using Found = std::vector<std::pair<ModelEntry, ModelStatus>>;

void printTable(const Found& found, bool all) {
  std::size_t width = 0;
  for (const auto& [entry, status] : found) {
    width = std::max(width, entry.file.size());
  }
  std::size_t left_out = 0;
  for (const auto& [entry, status] : found) {
    if (entry.method.empty() && status.state == ModelState::kAbsent && !all) {
      ++left_out;
      continue;
    }
    const std::string indent(width + 2, ' ');
    std::cout << entry.file << std::string(width + 2 - entry.file.size(), ' ')
              << toString(status.state) << "; " << entry.name << "; "
              << (entry.method.empty() ? "no plug-in yet" : "detector " + entry.method) << "\n";
    if (status.state == ModelState::kAbsent) {
      std::cout << indent << "get it: " << entry.get << "\n"
                << indent << entry.repository << " (" << entry.licence << ")\n";
    } else {
      std::cout << indent << status.file.string() << "\n"
                << indent << (status.state == ModelState::kDamaged ? "" : "SHA-256 ")
                << status.detail << "\n";
    }
    if (status.state == ModelState::kWrongSum && !entry.sha256.empty()) {
      std::cout << indent << "expected the SHA-256 " << entry.sha256 << "\n";
    }
  }
  if (left_out > 0) {
    std::cout << left_out << " more that no plug-in runs yet: evolin models --all\n";
  }
  std::cout << "\nsearched: " << searchedFolders() << "\n";
  if (!whyNoNetworks().empty()) {
    std::cout << "none can run: " << whyNoNetworks() << "\n";
  }
}

void printJson(const Found& found) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [entry, status] : found) {
    list.push_back({{"name", entry.name},
                    {"method", entry.method},
                    {"title", entry.title},
                    {"repository", entry.repository},
                    {"licence", entry.licence},
                    {"file", entry.file},
                    {"state", toString(status.state)},
                    {"path", status.file.string()},
                    {"detail", status.detail},
                    {"get", entry.get},
                    {"input", entry.input},
                    {"thresholds_evolin", entry.evolin},
                    {"thresholds_authors", entry.authors}});
  }
  // A path may hold bytes that are no UTF-8.
  std::cout << list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

int runModels(const std::vector<std::string>& arguments) {
  bool all = false;
  std::string format = "table";
  po::options_description description("Options");
  auto add = description.add_options();
  add("all", po::bool_switch(&all), "also networks that no plug-in runs yet");
  add("format", po::value(&format)->value_name("table|json")->default_value(format),
      "json has all of the list");
  if (!parseOptions(kUsage, description, arguments)) {
    return kExitDone;
  }
  if (format != "table" && format != "json") {
    throw UsageError("--format: is '" + format + "', expected table or json");
  }
  Found found;
  for (ModelEntry& entry : readModelCatalogue(modelCatalogueFile())) {
    ModelStatus status = statusOf(entry);
    found.emplace_back(std::move(entry), std::move(status));
  }
  if (format == "json") {
    printJson(found);
  } else {
    printTable(found, all);
  }
  return kExitDone;
}

}  // namespace

Command modelsCommand() {
  return {"models", "network files of learned methods: which are present, how to get them",
          runModels};
}

}  // namespace evolin::cli
