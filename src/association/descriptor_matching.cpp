// Matching of descriptors by nearest neighbour.
#include "evolin_ros/association/descriptor_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/hal.hpp>
#include <string>
#include <vector>

#include "distance_estimates.h"
#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

struct Nearest {
  std::size_t index = kNobody;
  double distance = std::numeric_limits<double>::infinity();
  double second_distance = std::numeric_limits<double>::infinity();

  void offer(std::size_t candidate, double candidate_distance) {
    if (candidate_distance < distance) {
      second_distance = distance;
      distance = candidate_distance;
      index = candidate;
    } else if (candidate_distance < second_distance) {
      second_distance = candidate_distance;
    }
  }
};

struct NearestPair {
  int first;
  int second;
  double distance;
  double rival;  // the next best one's
};

// Pairs of nearest rows among those chosen, by the first. `offer(i, &of_first, &of_second)` offers
// distances of first_rows[i] from `second_rows`; every one that is a row's smallest is among them,
// and its second smallest where `rules` ask for it.
template <typename Offer>
std::vector<NearestPair> pairNearest(const std::vector<int>& first_rows,
                                     const std::vector<int>& second_rows,
                                     const MatchingRules& rules, Offer offer) {
  std::vector<Nearest> of_first(first_rows.size());
  std::vector<Nearest> of_second(second_rows.size());
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    offer(i, &of_first, &of_second);
  }
  std::vector<NearestPair> pairs;
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    const Nearest& nearest = of_first[i];
    if (nearest.index == kNobody || (rules.cross_check && of_second[nearest.index].index != i)) {
      continue;  // nobody to match, or that one prefers another
    }
    const double rival = rules.cross_check ? std::min(nearest.second_distance,
                                                      of_second[nearest.index].second_distance)
                                           : nearest.second_distance;
    pairs.push_back({first_rows[i], second_rows[nearest.index], nearest.distance, rival});
  }
  return pairs;
}

bool asksForRatio(const MatchingRules& rules) { return rules.max_ratio < 1; }

bool keeps(const MatchingRules& rules, double distance, double rival) {
  return distance <= rules.max_distance &&
         (!asksForRatio(rules) || distance < rules.max_ratio * rival);
}

LineMatch makeMatch(const NearestPair& pair, double distance) {
  LineMatch match;
  match.first = static_cast<std::uint32_t>(pair.first);
  match.second = static_cast<std::uint32_t>(pair.second);
  match.distance = static_cast<float>(distance);
  return match;
}

void requireType(const cv::Mat& descriptors, const char* which, int type, const char* type_name) {
  if (descriptors.rows > 0 && descriptors.type() != type) {
    throw Error(std::string("descriptor matching: the ") + which + " matrix has OpenCV type " +
                std::to_string(descriptors.type()) + ", expected " + type_name +
                " with one channel");
  }
}

void requireEqualWidth(const cv::Mat& first, const cv::Mat& second) {
  if (first.cols != second.cols) {
    throw Error("descriptor matching: descriptors of " + std::to_string(first.cols) + " and of " +
                std::to_string(second.cols) + " values, expected equal sizes");
  }
}

void requireBits(const BinaryDescriptors& descriptors, const char* which) {
  requireType(descriptors.bits, which, CV_8U, "CV_8U");
  if (descriptors.valid.size() != static_cast<std::size_t>(descriptors.bits.rows)) {
    throw Error(std::string("descriptor matching: the ") + which + " descriptors have " +
                std::to_string(descriptors.bits.rows) + " rows and " +
                std::to_string(descriptors.valid.size()) + " marks of validity, expected as many");
  }
}

std::vector<int> validRows(const BinaryDescriptors& descriptors) {
  std::vector<int> rows;
  for (std::size_t i = 0; i < descriptors.valid.size(); ++i) {
    if (descriptors.valid[i] != 0) {
      rows.push_back(static_cast<int>(i));
    }
  }
  return rows;
}

std::vector<int> finiteRows(const cv::Mat& descriptors) {
  std::vector<int> rows;
  for (int i = 0; i < descriptors.rows; ++i) {
    const float* const row = descriptors.ptr<float>(i);
    if (std::all_of(row, row + descriptors.cols, [](float v) { return std::isfinite(v); })) {
      rows.push_back(i);
    }
  }
  return rows;
}

// The chosen rows as the columns of a matrix, with columns of zeros up to the next full block.
struct Columns {
  Columns(const cv::Mat& descriptors, const std::vector<int>& rows)
      : count((rows.size() + kEstimateColumns - 1) / kEstimateColumns * kEstimateColumns),
        values(count * static_cast<std::size_t>(descriptors.cols)) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const float* const row = descriptors.ptr<float>(rows[j]);
      for (int d = 0; d < descriptors.cols; ++d) {
        values[static_cast<std::size_t>(d) * count + j] = row[d];
      }
    }
  }

  std::size_t count;
  std::vector<float> values;
};

double squaredDistance(const float* first, const float* second, int size) {
  double sum = 0;
  for (int d = 0; d < size; ++d) {
    const double difference = static_cast<double>(first[d]) - static_cast<double>(second[d]);
    sum += difference * difference;
  }
  return sum;
}

// The largest estimate that one may have whose distance is not above that of the smallest estimate.
// Single precision keeps 24 bits of every difference, square and sum.
float farthestEstimate(float smallest, int size) {
  const float relative = 4 * static_cast<float>(size + 4) * std::numeric_limits<float>::epsilon();
  return smallest * (1 + relative) + 1e-30F;
}

// The smallest of numbers and the one after it; those that are not numbers do not count.
struct SmallestTwo {
  float first = std::numeric_limits<float>::infinity();
  float second = std::numeric_limits<float>::infinity();

  void offer(float value) {
    if (value < first) {
      second = first;
      first = value;
    } else if (value < second) {
      second = value;
    }
  }
};

// Exact distances are measured where estimates say that one of the two rows may be the nearest, or
// the second nearest where rules ask for that one.
class CandidatePairs {
 public:
  CandidatePairs(const cv::Mat& first, const std::vector<int>& first_rows, const cv::Mat& second,
                 const std::vector<int>& second_rows, const MatchingRules& rules)
      : first_(first),
        first_rows_(first_rows),
        second_(second),
        second_rows_(second_rows),
        rules_(rules),
        columns_(second, second_rows),
        keeps_all_(first_rows.size() * columns_.count <= kLargestMatrix) {
    estimates_.resize(keeps_all_ ? first_rows.size() * columns_.count : columns_.count);
    for (std::size_t i = 0; keeps_all_ && i < first_rows.size(); ++i) {
      estimate(i, estimates_.data() + i * columns_.count);
    }
    if (asksForRatio(rules)) {
      findLimits<SmallestTwo>([](const SmallestTwo& two) { return two.second; });
    } else {
      findLimits<Smallest>([](const Smallest& smallest) { return smallest.value; });
    }
  }

  // Offers row i of the first to the nearest of both sides.
  void offer(std::size_t i, std::vector<Nearest>* of_first, std::vector<Nearest>* of_second) {
    const float* const row = estimatesOf(i);
    for (std::size_t j = 0; j < second_rows_.size(); ++j) {
      if (row[j] <= std::max(first_limits_[i], second_limits_[j])) {
        const double distance = squaredDistance(first_.ptr<float>(first_rows_[i]),
                                                second_.ptr<float>(second_rows_[j]), first_.cols);
        (*of_first)[i].offer(j, distance);
        (*of_second)[j].offer(i, distance);
      }
    }
  }

 private:
  struct Smallest {
    float value = std::numeric_limits<float>::infinity();

    void offer(float other) { value = std::min(value, other); }
  };

  // Estimates of all pairs, 64 MB; where there are more each row is estimated when it is asked for.
  static constexpr std::size_t kLargestMatrix = std::size_t{1} << 24;

  // Pairs that may not match get NaN, with which nothing compares.
  void estimate(std::size_t i, float* row) const {
    estimateDistances(first_.ptr<float>(first_rows_[i]), columns_.values.data(),
                      static_cast<std::size_t>(first_.cols), columns_.count, row);
    for (std::size_t j = 0; rules_.may_match && j < second_rows_.size(); ++j) {
      if (!rules_.may_match(static_cast<std::size_t>(first_rows_[i]),
                            static_cast<std::size_t>(second_rows_[j]))) {
        row[j] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }

  // Until the next call.
  const float* estimatesOf(std::size_t i) {
    if (keeps_all_) {
      return estimates_.data() + i * columns_.count;
    }
    estimate(i, estimates_.data());
    return estimates_.data();
  }

  // `Lowest` takes the estimates of a row or column, `limit` says which of them counts.
  template <typename Lowest, typename Limit>
  void findLimits(const Limit& limit) {
    std::vector<Lowest> of_second(second_rows_.size());
    first_limits_.resize(first_rows_.size());
    for (std::size_t i = 0; i < first_rows_.size(); ++i) {
      const float* const row = estimatesOf(i);
      Lowest of_first;
      for (std::size_t j = 0; j < second_rows_.size(); ++j) {
        of_first.offer(row[j]);
        of_second[j].offer(row[j]);
      }
      first_limits_[i] = farthestEstimate(limit(of_first), first_.cols);
    }
    second_limits_.resize(second_rows_.size());
    for (std::size_t j = 0; j < second_rows_.size(); ++j) {
      second_limits_[j] = farthestEstimate(limit(of_second[j]), first_.cols);
    }
  }

  const cv::Mat& first_;
  const std::vector<int>& first_rows_;
  const cv::Mat& second_;
  const std::vector<int>& second_rows_;
  const MatchingRules& rules_;
  Columns columns_;
  bool keeps_all_;
  std::vector<float> estimates_;
  std::vector<float> first_limits_;
  std::vector<float> second_limits_;
};

}  // namespace

LineMatches matchDescriptors(const cv::Mat& first, const cv::Mat& second,
                             const MatchingRules& rules) {
  requireType(first, "first", CV_32F, "CV_32F");
  requireType(second, "second", CV_32F, "CV_32F");
  if (first.rows == 0 || second.rows == 0) {
    return {};
  }
  requireEqualWidth(first, second);
  const std::vector<int> first_rows = finiteRows(first);
  const std::vector<int> second_rows = finiteRows(second);
  CandidatePairs candidates(first, first_rows, second, second_rows, rules);
  const auto offer = [&](std::size_t i, auto* of_first, auto* of_second) {
    candidates.offer(i, of_first, of_second);
  };
  LineMatches matches;
  for (const NearestPair& pair : pairNearest(first_rows, second_rows, rules, offer)) {
    const double distance = std::sqrt(pair.distance);
    if (keeps(rules, distance, std::sqrt(pair.rival))) {
      matches.push_back(makeMatch(pair, distance));
    }
  }
  return matches;
}

LineMatches matchBinaryDescriptors(const BinaryDescriptors& first, const BinaryDescriptors& second,
                                   const MatchingRules& rules) {
  requireBits(first, "first");
  requireBits(second, "second");
  if (first.bits.rows == 0 || second.bits.rows == 0) {
    return {};
  }
  requireEqualWidth(first.bits, second.bits);
  const std::vector<int> first_rows = validRows(first);
  const std::vector<int> second_rows = validRows(second);
  const auto offer = [&](std::size_t i, auto* of_first, auto* of_second) {
    const std::uint8_t* const row = first.bits.ptr<std::uint8_t>(first_rows[i]);
    for (std::size_t j = 0; j < second_rows.size(); ++j) {
      if (rules.may_match && !rules.may_match(static_cast<std::size_t>(first_rows[i]),
                                              static_cast<std::size_t>(second_rows[j]))) {
        continue;
      }
      const double distance =
          cv::hal::normHamming(row, second.bits.ptr<std::uint8_t>(second_rows[j]), first.bits.cols);
      (*of_first)[i].offer(j, distance);
      (*of_second)[j].offer(i, distance);
    }
  };
  LineMatches matches;
  for (const NearestPair& pair : pairNearest(first_rows, second_rows, rules, offer)) {
    if (keeps(rules, pair.distance, pair.rival)) {
      matches.push_back(makeMatch(pair, pair.distance));
    }
  }
  return matches;
}

}  // namespace evolin
