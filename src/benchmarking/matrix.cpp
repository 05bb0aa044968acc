// From four lists to cells.
#include "evolin_ros/benchmarking/matrix.h"

#include <algorithm>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

constexpr const char* kNone = "none";

MetricFamilies both(const MetricFamilies& a, const MetricFamilies& b) {
  MetricFamilies common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(),
                        std::inserter(common, common.end()));
  return common;
}

void merge(const YAML::Node& from, YAML::Node* into) {
  for (const auto& entry : from) {
    (*into)[entry.first.Scalar()] = YAML::Clone(entry.second);
  }
}

YAML::Node evaluationOf(const BenchmarkSetting& setting, const BenchmarkMethod* detector,
                        const MetricFamilies& metrics) {
  YAML::Node evaluation = YAML::Clone(setting.evaluation);
  const char* const thresholds = "repeatability_score_thresholds";
  if (detector != nullptr) {
    if (detector->repeatability_threshold && metrics.count(MetricFamily::kRepeatability) != 0 &&
        !setting.evaluation[thresholds]) {
      evaluation[thresholds].push_back(formatDouble(*detector->repeatability_threshold));
    }
    merge(detector->evaluation, &evaluation);
  }
  for (const MetricFamily family : metrics) {
    evaluation["metrics"].push_back(toString(family));
  }
  return evaluation;
}

/// A threshold for poses cuts lines before they are associated, and so before all else is measured.
LineSelection selectionOf(const BenchmarkSetting& setting, const BenchmarkMethod* detector,
                          const MetricFamilies& metrics) {
  LineSelection selection = setting.selection;
  if (detector == nullptr || !detector->pose_threshold || setting.associate_ground_truth ||
      metrics.count(MetricFamily::kPose) == 0 ||
      selection.score_threshold > LineSelection::kNoScoreThreshold) {
    return selection;
  }
  for (const MetricFamily family : metrics) {
    if (family != MetricFamily::kPose && family != MetricFamily::kAssociation) {
      throw Error(setting.place + ": setting " + quote(setting.name) + " measures pose and " +
                  toString(family) + ", but detector " + quote(detector->name) +
                  " has a score threshold for pose, which would leave out lines that " +
                  toString(family) + " counts; expected a setting of its own for pose");
    }
  }
  selection.score_threshold = *detector->pose_threshold;
  return selection;
}

std::vector<std::optional<std::size_t>> choices(bool needed,
                                                const std::vector<std::size_t>& places) {
  if (!needed) {
    return {std::nullopt};
  }
  return {places.begin(), places.end()};
}

void addCells(BenchmarkMatrix* matrix, std::size_t sequence, std::size_t place) {
  const BenchmarkSetting& setting = matrix->settings[place];
  const MetricFamilies metrics = both(matrix->sequences[sequence].metrics, setting.metrics);
  if (metrics.empty()) {
    return;
  }
  const bool matches = std::any_of(metrics.begin(), metrics.end(), needsMatches);
  const bool lines = std::any_of(metrics.begin(), metrics.end(), [&setting](MetricFamily family) {
    return needsDetector(family, setting.associate_ground_truth);
  });
  for (const std::optional<std::size_t>& detector : choices(lines, setting.detectors)) {
    const BenchmarkMethod* method = detector ? &matrix->detectors[*detector] : nullptr;
    for (const std::optional<std::size_t>& associator : choices(matches, setting.associators)) {
      BenchmarkCell cell;
      cell.sequence = sequence;
      cell.detector = detector;
      cell.associator = associator;
      cell.setting = place;
      cell.evaluation = evaluationOf(setting, method, metrics);
      cell.selection = selectionOf(setting, method, metrics);
      cell.id = matrix->sequences[sequence].name + "--" + detectorName(*matrix, cell) + "--" +
                associatorName(*matrix, cell) + "--" + setting.name;
      matrix->cells.push_back(std::move(cell));
    }
  }
}

}  // namespace

bool needsMatches(MetricFamily family) {
  return family == MetricFamily::kAssociation || family == MetricFamily::kPose;
}

bool needsDetector(MetricFamily family, bool associate_ground_truth) {
  return !needsMatches(family) || !associate_ground_truth;
}

std::string detectorName(const BenchmarkMatrix& matrix, const BenchmarkCell& cell) {
  return cell.detector ? matrix.detectors[*cell.detector].name : kNone;
}

std::string associatorName(const BenchmarkMatrix& matrix, const BenchmarkCell& cell) {
  return cell.associator ? matrix.associators[*cell.associator].name : kNone;
}

void expandCells(BenchmarkMatrix* matrix) {
  matrix->cells.clear();
  for (std::size_t sequence = 0; sequence < matrix->sequences.size(); ++sequence) {
    for (std::size_t place = 0; place < matrix->settings.size(); ++place) {
      const std::vector<std::size_t>& wanted = matrix->settings[place].sequences;
      if (std::find(wanted.begin(), wanted.end(), sequence) != wanted.end()) {
        addCells(matrix, sequence, place);
      }
    }
  }
}

}  // namespace evolin
