// `evolin evaluate association`.
#include <boost/program_options/value_semantic.hpp>

#include "classification_entries.h"
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
  const ClassificationWords words = {"no pairs are predicted", "no true pairs are given"};
  deliverResults(options, classificationEntries({}, pairs, words, options));
  return kExitDone;
}

}  // namespace evolin::cli
