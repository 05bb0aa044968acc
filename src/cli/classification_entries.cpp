// The three ratios of a classification, and when they are none.
#include "classification_entries.h"

#include <cstdint>

namespace evolin::cli {

namespace {

std::vector<double> ratiosOf(const Classification& counts) {
  return {counts.precision(), counts.recall(), counts.fScore()};
}

}  // namespace

ClassificationWords detectionWords() {
  return {"no lines were detected", "no lines are annotated"};
}

std::string whyUndefined(const Classification& counts, const ClassificationWords& words) {
  if (counts.ground_truth == 0) {
    return words.nothing_true;
  }
  return counts.predicted == 0 ? words.nothing_predicted : "";
}

std::vector<PublishedEntry> classificationEntries(const PublishedEntry& prototype,
                                                  const std::vector<Classification>& frames,
                                                  const ClassificationWords& words,
                                                  const EvaluateOptions& options) {
  const Classification sum = weightedSum(frames, std::vector<std::uint32_t>(frames.size(), 1));
  const std::vector<double> values = ratiosOf(sum);
  const std::vector<ConfidenceInterval> intervals =
      intervalsFor(options, frames.size(), [&frames](const std::vector<std::uint32_t>& weights) {
        return ratiosOf(weightedSum(frames, weights));
      });
  const std::vector<std::string> names = {"precision", "recall", "fscore"};
  const std::vector<std::string> undefined = {sum.predicted == 0 ? words.nothing_predicted : "",
                                              sum.ground_truth == 0 ? words.nothing_true : "",
                                              whyUndefined(sum, words)};
  std::vector<PublishedEntry> entries(names.size(), prototype);
  for (std::size_t index = 0; index < names.size(); ++index) {
    entries[index].name = names[index];
    entries[index].value = values[index];
    entries[index].undefined = undefined[index];
    if (!intervals.empty()) {
      entries[index].confidence_interval = intervals[index];
    }
  }
  return entries;
}

}  // namespace evolin::cli
