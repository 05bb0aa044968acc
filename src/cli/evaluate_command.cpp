// Chooses the metric family.
#include "evaluate_command.h"

#include <algorithm>
#include <iostream>

#include "evaluate_families.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/base/text.h"

namespace evolin::cli {

namespace {

struct Family {
  std::string name;
  std::string summary;
  int (*run)(const std::vector<std::string>& arguments);
};

const std::vector<Family>& families() {
  static const std::vector<Family> kFamilies = {
      {"vectorized", "detected lines against true lines as vectors: precision, recall, F-score, AP",
       evaluateVectorized},
      {"heatmap", "detected lines against true lines as pixels: precision, recall, F-score, AP",
       evaluateHeatmap},
      {"association", "matched index pairs against true ones: precision, recall, F-score",
       evaluateAssociation},
      {"repeatability", "lines found again in later frames: repeatability, localisation error",
       evaluateRepeatability},
      {"pose", "relative pose from matched lines: rotation and translation errors", evaluatePose},
  };
  return kFamilies;
}

/// "vectorized, heatmap or pose".
std::string familyNames() {
  std::string text;
  for (std::size_t index = 0; index < families().size(); ++index) {
    text += (index == 0                       ? ""
             : index + 1 == families().size() ? " or "
                                              : ", ") +
            families()[index].name;
  }
  return text;
}

void printHelp() {
  std::cout << "Computes one metric family of the EVOLIN benchmark on folders of CSV files.\n\n"
               "Usage: evolin evaluate FAMILY [OPTIONS]\n\n"
               "Families:\n";
  for (const Family& family : families()) {
    std::cout << "  " << family.name << std::string(15 - family.name.size(), ' ') << family.summary
              << '\n';
  }
  std::cout << "\nevolin evaluate FAMILY --help tells a family's options.\n"
               "Files pair by stem. Exit status: 0 done, 1 the data or the run failed, 2 wrong "
               "use, 130 interrupted.\n";
}

int runEvaluate(const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const Family& family : families()) {
    names.push_back(family.name);
  }
  if (arguments.empty()) {
    throw UsageError("no metric family given; expected " + familyNames());
  }
  const std::string& name = arguments[0];
  if (name == "--help" || name == "-h") {
    printHelp();
    return kExitDone;
  }
  const auto family = std::find_if(families().begin(), families().end(),
                                   [&name](const Family& known) { return known.name == name; });
  if (family == families().end()) {
    throw UsageError("unknown metric family " + quote(name) + "; did you mean '" +
                     nearestWord(name, names) + "'?");
  }
  return family->run({arguments.begin() + 1, arguments.end()});
}

}  // namespace

Command evaluateCommand() {
  return {"evaluate", "one metric family on folders of files", runEvaluate};
}

}  // namespace evolin::cli
