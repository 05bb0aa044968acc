// A folder with a matrix in which `evolin benchmark` runs, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "benchmark_command.h"
#include "test/cli/outcome.h"
#include "test/support/temporary_folder.h"

namespace evolin::test {

inline nlohmann::json readJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

/// What a report found, without times and places.
inline nlohmann::json figuresOf(nlohmann::json report) {
  report.erase("timing");
  report.erase("provenance");
  return report;
}

/// A matrix, its results, and what they hold.
class BenchmarkTest : public ::testing::Test {
 protected:
  using Json = nlohmann::json;

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  void writeMatrix(const std::string& text) const { folder_.write("matrix.yaml", text); }

  std::vector<std::string> command(const std::string& output,
                                   const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"benchmark", "--config", path("matrix.yaml"), "--output",
                                          path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  Outcome run(const std::string& output, const std::vector<std::string>& more = {}) const {
    return runCaptured({cli::benchmarkCommand()}, command(output, more));
  }

  Json cell(const std::string& output, const std::string& id) const {
    return readJson(folder_.path() / output / "cells" / id / "cell.json");
  }

  Json report(const std::string& output, const std::string& id) const {
    return readJson(folder_.path() / output / "cells" / id / "report.json");
  }

  std::map<std::string, std::string> states(const std::string& output) const {
    std::map<std::string, std::string> states;
    const Json matrix = readJson(folder_.path() / output / "matrix.json");
    for (const Json& cell : matrix.at("cells")) {
      states[cell.at("id")] = cell.at("state");
    }
    return states;
  }

  /// The figures of all cells, and which cells there are.
  std::map<std::string, Json> figures(const std::string& output) const {
    std::map<std::string, Json> figures;
    for (const auto& [id, state] : states(output)) {
      EXPECT_EQ(state, "finished") << id;
      figures[id] = figuresOf(report(output, id));
    }
    return figures;
  }

  /// All but the synthetic sequences' folders, hidden or not.
  std::set<std::string> entries(const std::string& folder) const {
    std::set<std::string> names;
    for (const std::filesystem::directory_entry& entry :
         std::filesystem::directory_iterator(folder_.path() / folder)) {
      if (entry.is_directory()) {
        names.insert(entry.path().filename().string());
      }
    }
    return names;
  }

  TemporaryFolder folder_;
  const std::string small_ =
      "evaluation: {bootstrap: 20, repeatability_steps: [1]}\n"
      "sequences:\n- {name: room, synthetic: {frames: 6, width: 160, height: 120}}\n"
      "detectors:\n- {name: lsd, label: LSD}\n- {name: segments, plugin: elsed}\n"
      "associators: [lbd]\n"
      "settings:\n"
      "- {name: lines, metrics: [detection, heatmap, repeatability]}\n"
      "- {name: truth, metrics: [association]}\n"
      "- {name: poses, metrics: [association, pose], associate: detected}\n";
};

}  // namespace evolin::test
