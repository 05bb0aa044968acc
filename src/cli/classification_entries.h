// Precision, recall and F-score as entries of the results.
#pragma once

#include <string>
#include <vector>

#include "evaluate_options.h"
#include "evolin_ros/metrics/classification.h"
#include "published_json.h"

namespace evolin::cli {

/// Why a ratio has no value, in words of the family.
struct ClassificationWords {
  std::string nothing_predicted;
  std::string nothing_true;
};

/// Those of a detection: "no lines were detected", "no lines are annotated".
ClassificationWords detectionWords();

/// Why a figure that needs predictions and truth has no value; "" when it has one.
std::string whyUndefined(const Classification& counts, const ClassificationWords& words);

/// precision, recall and fscore of the sum over `frames`, with intervals where --bootstrap asks for
/// them. What the entries depend on is copied from `prototype`. A ratio of nothing has the value 0
/// and says why it is none.
std::vector<PublishedEntry> classificationEntries(const PublishedEntry& prototype,
                                                  const std::vector<Classification>& frames,
                                                  const ClassificationWords& words,
                                                  const EvaluateOptions& options);

}  // namespace evolin::cli
