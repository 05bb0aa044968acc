// Association as sets of index pairs.
#include "evolin_ros/metrics/association.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

/// Row of every id >= 0.
std::unordered_map<std::int64_t, std::size_t> rowsById(const LineSegments& lines,
                                                       const std::string& frame) {
  std::unordered_map<std::int64_t, std::size_t> rows;
  rows.reserve(lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (lines[row].id < 0) {
      continue;
    }
    const auto [found, inserted] = rows.emplace(lines[row].id, row);
    if (!inserted) {
      throw GroundTruthError(frame, row,
                             "id " + std::to_string(lines[row].id) + " is also that of row " +
                                 std::to_string(found->second) +
                                 "; expected one line an id in a frame");
    }
  }
  return rows;
}

IndexPairs sortedUnique(IndexPairs pairs) {
  // Matchers mostly give pairs in order of rows.
  if (!std::is_sorted(pairs.begin(), pairs.end())) {
    std::sort(pairs.begin(), pairs.end());
  }
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

IndexPairs pairsOfEqualIds(const LineSegments& first, const LineSegments& second,
                           const std::string& first_name, const std::string& second_name) {
  rowsById(first, first_name);  // only to refuse repeated ids
  const auto rows = rowsById(second, second_name);
  IndexPairs pairs;
  for (std::size_t row = 0; row < first.size(); ++row) {
    const auto found = rows.find(first[row].id);
    if (found != rows.end()) {
      pairs.emplace_back(static_cast<std::int64_t>(row), static_cast<std::int64_t>(found->second));
    }
  }
  return pairs;
}

IndexPairs toIndexPairs(const LineMatches& matches) {
  IndexPairs pairs;
  pairs.reserve(matches.size());
  for (const LineMatch& match : matches) {
    pairs.emplace_back(match.first, match.second);
  }
  return pairs;
}

Classification classifyAssociation(const IndexPairs& predicted, const IndexPairs& truth) {
  const IndexPairs true_pairs = sortedUnique(truth);
  const IndexPairs distinct = sortedUnique(predicted);
  Classification counts;
  counts.predicted = predicted.size();
  counts.ground_truth = truth.size();
  auto truth_place = true_pairs.begin();
  for (const IndexPair& pair : distinct) {
    while (truth_place != true_pairs.end() && *truth_place < pair) {
      ++truth_place;
    }
    counts.true_positives += truth_place != true_pairs.end() && *truth_place == pair ? 1 : 0;
  }
  return counts;
}

Classification AssociationMetrics::addPair(const IndexPairs& predicted, const IndexPairs& truth) {
  const Classification counts = classifyAssociation(predicted, truth);
  sum_ += counts;
  ++pairs_;
  return counts;
}

void AssociationMetrics::merge(const AssociationMetrics& other) {
  // Both values are read before either is written, so an accumulator may be merged with itself.
  const std::size_t pairs = other.pairs_;
  const Classification sum = other.sum_;
  sum_ += sum;
  pairs_ += pairs;
}

void AssociationMetrics::reset() { *this = AssociationMetrics(); }

}  // namespace evolin
