// Carrying ids over to detected lines, and counting pairs and physical lines.
#include "evolin_ros/metrics/detected_association.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "nearest_line.h"
#include "scaling.h"

namespace evolin {

namespace {

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Ids >= 0, rising, each once.
std::vector<std::int64_t> distinctIds(const std::vector<std::int64_t>& ids) {
  std::vector<std::int64_t> result;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(result),
               [](std::int64_t id) { return id >= 0; });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void checkPair(const IndexPair& pair, std::size_t first, std::size_t second) {
  const auto inside = [](std::int64_t row, std::size_t rows) {
    return row >= 0 && static_cast<std::uint64_t>(row) < rows;
  };
  if (!inside(pair.first, first) || !inside(pair.second, second)) {
    throw Error("match (" + std::to_string(pair.first) + ", " + std::to_string(pair.second) +
                "): expected rows of " + std::to_string(first) + " lines in the first and " +
                std::to_string(second) + " in the second frame");
  }
}

}  // namespace

std::vector<std::int64_t> carryOverIds(const std::string& frame_name, ImageSize size,
                                       const LineSegments& detected,
                                       const LineSegments& ground_truth, double gate) {
  if (size.width <= 0 || size.height <= 0) {
    throw Error("image of frame " + frame_name + ": size " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + "; expected a positive number of pixels");
  }
  if (!(gate > 0) || !std::isfinite(gate)) {
    throw Error("carry-over gate " + formatDouble(gate) +
                ": expected a positive, finite number of pixels");
  }
  LineSegments truth;
  truth.reserve(ground_truth.size());
  for (std::size_t row = 0; row < ground_truth.size(); ++row) {
    if (!ground_truth[row].isFinite()) {
      throw GroundTruthError(frame_name, row, coordinates(ground_truth[row]) + " is not finite");
    }
    truth.push_back(scaled(ground_truth[row], size));
  }
  NearestLineSearch search(truth);
  std::vector<std::int64_t> ids(detected.size(), kNoId);
  for (std::size_t row = 0; row < detected.size(); ++row) {
    if (!detected[row].isFinite()) {
      throw Error("detected lines of frame " + frame_name + ", row " + std::to_string(row) + ": " +
                  coordinates(detected[row]) + " is not finite");
    }
    const NearestLine nearest =
        search.find(LineDistance::kStructural, scaled(detected[row], size), gate, false);
    if (std::isfinite(nearest.distance)) {
      ids[row] = std::max(truth[nearest.row].id, kNoId);
    }
  }
  return ids;
}

double DetectedAssociation::precision() const { return ratio(true_pairs, predicted_pairs); }

double DetectedAssociation::recall() const { return ratio(joined_lines, visible_lines); }

double DetectedAssociation::fScore() const {
  const double p = precision();
  const double r = recall();
  return p + r > 0 ? 2 * p * r / (p + r) : 0.0;
}

DetectedAssociation& DetectedAssociation::operator+=(const DetectedAssociation& other) {
  true_pairs += other.true_pairs;
  predicted_pairs += other.predicted_pairs;
  pairs_without_truth += other.pairs_without_truth;
  joined_lines += other.joined_lines;
  visible_lines += other.visible_lines;
  return *this;
}

DetectedAssociation classifyDetectedAssociation(const IndexPairs& predicted,
                                                const std::vector<std::int64_t>& first_ids,
                                                const std::vector<std::int64_t>& second_ids) {
  DetectedAssociation counts;
  counts.predicted_pairs = predicted.size();
  IndexPairs distinct = predicted;
  std::sort(distinct.begin(), distinct.end());
  std::vector<std::int64_t> joined;
  for (std::size_t index = 0; index < distinct.size(); ++index) {
    const IndexPair& pair = distinct[index];
    checkPair(pair, first_ids.size(), second_ids.size());
    const std::int64_t first = first_ids[static_cast<std::size_t>(pair.first)];
    const std::int64_t second = second_ids[static_cast<std::size_t>(pair.second)];
    if (first < 0 || second < 0) {
      ++counts.pairs_without_truth;
    } else if (first == second && (index == 0 || distinct[index - 1] != pair)) {
      ++counts.true_pairs;
      joined.push_back(first);
    }
  }
  counts.joined_lines = distinctIds(joined).size();
  const std::vector<std::int64_t> first = distinctIds(first_ids);
  const std::vector<std::int64_t> second = distinctIds(second_ids);
  std::vector<std::int64_t> visible;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                        std::back_inserter(visible));
  counts.visible_lines = visible.size();
  return counts;
}

DetectedAssociation DetectedAssociationMetrics::addPair(
    const IndexPairs& predicted, const std::vector<std::int64_t>& first_ids,
    const std::vector<std::int64_t>& second_ids) {
  const DetectedAssociation counts = classifyDetectedAssociation(predicted, first_ids, second_ids);
  sum_ += counts;
  ++pairs_;
  return counts;
}

void DetectedAssociationMetrics::merge(const DetectedAssociationMetrics& other) {
  // Both values are read before either is written, so an accumulator may be merged with itself.
  const DetectedAssociation sum = other.sum_;
  const std::size_t pairs = other.pairs_;
  sum_ += sum;
  pairs_ += pairs;
}

void DetectedAssociationMetrics::reset() { *this = DetectedAssociationMetrics(); }

}  // namespace evolin
