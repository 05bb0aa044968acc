// `evolin list`.
#include "list_command.h"

#include <boost/program_options/options_description.hpp>

#include <algorithm>
#include <iostream>

#include "evolin_ros/dataset/camera_file.h"
#include "options.h"
#include "package_files.h"
#include "plugin_loader.h"

namespace evolin::cli {

namespace {

constexpr const char* kUsage =
    "Prints the detectors, associators, metrics, cameras and dataset layouts that are available "
    "here, "
    "and why one is not.\n\n"
    "Usage: evolin list";

using Row = std::pair<std::string, std::string>;

void printRows(const std::string& title, const std::vector<Row>& rows) {
  std::size_t width = 0;
  for (const Row& row : rows) {
    width = std::max(width, row.first.size());
  }
  std::cout << title << "\n";
  for (const auto& [name, text] : rows) {
    std::cout << "  " << name << std::string(width - name.size() + 2, ' ') << text << "\n";
  }
  std::cout << "\n";
}

std::vector<Row> rowsOf(const std::vector<PluginInfo>& plugins) {
  std::vector<Row> rows;
  for (const PluginInfo& plugin : plugins) {
    const std::string package =
        plugin.package == "evolin_ros" ? "" : " (package " + plugin.package + ")";
    rows.emplace_back(plugin.name, plugin.why_unavailable.empty()
                                       ? plugin.description + package
                                       : "NOT AVAILABLE: " + plugin.why_unavailable + package);
  }
  return rows;
}

std::vector<Row> cameraRows() {
  std::vector<Row> rows;
  for (const std::string& name : listCameraPresets(cameraFolder())) {
    const Camera camera = loadCamera(name, cameraFolder());
    rows.emplace_back(name, std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                                ", " + camera.distortion_model +
                                (camera.distortion.empty() ? ", no distortion" : ""));
  }
  return rows;
}

int runList(const std::vector<std::string>& arguments) {
  if (!parseOptions(kUsage, boost::program_options::options_description("Options"), arguments)) {
    return kExitDone;
  }
  PluginLoader loader;
  printRows("Detectors", rowsOf(loader.listDetectors()));
  printRows("Associators", rowsOf(loader.listAssociators()));
  printRows("Metrics",
            {{"vectorized", "detection: precision, recall, F-score, average precision on segments"},
             {"association", "precision, recall, F-score of matched pairs"}});
  printRows("Cameras", cameraRows());
  printRows("Datasets",
            {{"tum", "TUM RGB-D folder: rgb.txt, depth.txt, groundtruth.txt"},
             {"icl", "ICL-NUIM in its TUM-compatible form: associations.txt, *.gt.freiburg"},
             {"evolin",
              "EVOLIN folder: images or rgb, gt_lines, poses.txt, "
              "calibration_matrix.txt, depth_associations.txt"}});
  return kExitDone;
}

}  // namespace

Command listCommand() {
  return {"list", "detectors, associators, metrics, cameras, datasets available here", runList};
}

}  // namespace evolin::cli
