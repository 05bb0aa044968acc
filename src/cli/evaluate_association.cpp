// `evolin evaluate association`.
#include <boost/program_options/value_semantic.hpp>

#include "evaluate_families.h"
#include "evaluate_options.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/association.h"
#include "file_pairing.h"
#include "options.h"
#include "parallel.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Scores matched line pairs against the true ones: precision, recall and F-score over all pairs "
    "of frames.\n\n"
    "Usage: evolin evaluate association --pred-associations DIR --gt-associations DIR [OPTIONS]";

std::vector<double> figuresOf(const Classification& counts) {
  return {counts.precision(), counts.recall(), counts.fScore()};
}

}  // namespace

int evaluateAssociation(const std::vector<std::string>& arguments) {
  std::string predicted_folder;
  std::string true_folder;
  EvaluateOptions options;
  po::options_description description("Options");
  description.add_options()("pred-associations,p",
                            po::value(&predicted_folder)->value_name("DIR")->required(),
                            "predicted index pairs, one CSV (rows i,j) a pair of frames")(
      "gt-associations,g", po::value(&true_folder)->value_name("DIR")->required(),
      "true index pairs, under the same names");
  addEvaluateOptions("classification_metrics.json", &options, &description);
  if (!parseOptions(kUsage, description, arguments)) {
    return kExitDone;
  }
  checkEvaluateOptions(options);

  const FileSet predicted = listByStem("predicted associations", predicted_folder, {".csv"});
  const FileSet truth = listByStem("true associations", true_folder, {".csv"});
  requireSameStems(truth, predicted);
  std::vector<std::string> stems;
  for (const auto& [stem, file] : truth.files) {
    stems.push_back(stem);
  }
  std::vector<Classification> pairs(stems.size());
  forEachTask(stems.size(), threadsFor(options, stems.size()),
              [&](std::size_t task, std::size_t /*worker*/) {
                pairs[task] = classifyAssociation(readIndexPairsCsv(predicted.at(stems[task])),
                                                  readIndexPairsCsv(truth.at(stems[task])));
              });
  Classification sum;
  for (const Classification& pair : pairs) {
    sum += pair;
  }
  const std::vector<ConfidenceInterval> intervals =
      intervalsFor(options, pairs.size(), [&pairs](const std::vector<std::uint32_t>& weights) {
        return figuresOf(weightedSum(pairs, weights));
      });

  const std::vector<std::string> names = {"precision", "recall", "fscore"};
  const std::vector<double> values = figuresOf(sum);
  std::vector<PublishedEntry> entries(names.size());
  for (std::size_t index = 0; index < names.size(); ++index) {
    entries[index].name = names[index];
    entries[index].value = values[index];
    if (!intervals.empty()) {
      entries[index].confidence_interval = intervals[index];
    }
  }
  deliverResults(options, entries);
  return kExitDone;
}

}  // namespace evolin::cli
