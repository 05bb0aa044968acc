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

// Not finite where a value is not. The partial sums do not wait for each other.
double sumOfSquares(const float* values, int size) {
  constexpr int kPartial = 8;
  double partial[kPartial] = {};
  int d = 0;
  for (; d + kPartial <= size; d += kPartial) {
    for (int k = 0; k < kPartial; ++k) {
      partial[k] += static_cast<double>(values[d + k]) * static_cast<double>(values[d + k]);
    }
  }
  double sum = 0;
  for (; d < size; ++d) {
    sum += static_cast<double>(values[d]) * static_cast<double>(values[d]);
  }
  for (const double part : partial) {
    sum += part;
  }
  return sum;
}

// The rows of descriptors whose values are finite.
struct FiniteRows {
  explicit FiniteRows(const cv::Mat& descriptors) {
    rows.reserve(static_cast<std::size_t>(descriptors.rows));
    estimated.reserve(static_cast<std::size_t>(descriptors.rows));
    for (int i = 0; i < descriptors.rows; ++i) {
      const float* const values = descriptors.ptr<float>(i);
      const double squares = sumOfSquares(values, descriptors.cols);
      if (std::isfinite(squares)) {
        rows.push_back(i);
        estimated.push_back({values, static_cast<float>(squares)});
        largest_squares = std::max(largest_squares, squares);
      }
    }
  }

  std::vector<int> rows;
  std::vector<EstimateRow> estimated;
  double largest_squares = 0;
};

// Descriptors as EstimateColumns has them, with columns that are near nothing up to the last
// matrix's end.
struct Columns {
  Columns(const std::vector<EstimateRow>& rows, std::size_t size)
      : count((rows.size() + kEstimateColumns - 1) / kEstimateColumns * kEstimateColumns),
        values(count * size),
        squares(count, std::numeric_limits<float>::quiet_NaN()) {
    for (std::size_t begin = 0; begin < rows.size(); begin += kEstimateColumns) {
      const std::size_t width = std::min(kEstimateColumns, rows.size() - begin);
      float* matrix = values.data() + begin * size;
      for (std::size_t d = 0; d < size; ++d) {
        for (std::size_t j = 0; j < width; ++j) {
          matrix[j] = rows[begin + j].values[d];
        }
        matrix += kEstimateColumns;
      }
    }
    for (std::size_t j = 0; j < rows.size(); ++j) {
      squares[j] = rows[j].squares;
    }
  }

  std::size_t count;
  std::vector<float> values;
  std::vector<float> squares;
};

double squaredDistance(const float* first, const float* second, int size) {
  double sum = 0;
  for (int d = 0; d < size; ++d) {
    const double difference = static_cast<double>(first[d]) - static_cast<double>(second[d]);
    sum += difference * difference;
  }
  return sum;
}

// Sums of squares up to here leave single precision room for sums of them.
constexpr double kLargestSquares = 1e36;

// Single precision keeps 24 bits of every square, product and sum. This is twice what two estimates
// together may be wrong by, so that one is not this far above another whose row is farther away.
float estimateMargin(double largest_squares, std::size_t size) {
  const double relative = 2 * static_cast<double>(size + 8) * std::numeric_limits<float>::epsilon();
  return static_cast<float>(largest_squares * relative + 1e-30);
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
  CandidatePairs(const FiniteRows& first, const FiniteRows& second, int size,
                 const MatchingRules& rules)
      : first_(first),
        second_(second),
        size_(size),
        rules_(rules),
        columns_(second.estimated, static_cast<std::size_t>(size)),
        estimates_anything_(std::max(first.largest_squares, second.largest_squares) <=
                            kLargestSquares),
        margin_(estimateMargin(first.largest_squares + second.largest_squares,
                               static_cast<std::size_t>(size))),
        keeps_all_(first.rows.size() * columns_.count <= kLargestMatrix),
        places_(columns_.count) {
    estimates_.resize(keeps_all_ ? first.rows.size() * columns_.count : columns_.count);
    if (keeps_all_) {
      estimate(0, first.rows.size());
    }
    asksForRatio(rules) ? findSecondLimits() : findLimits();
  }

  // Offers row i of the first to the nearest of both sides.
  void offer(std::size_t i, std::vector<Nearest>* of_first, std::vector<Nearest>* of_second) {
    const std::size_t count = findCandidates(estimatesOf(i), columns_.count, first_limits_[i],
                                             second_limits_.data(), places_.data());
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t j = places_[k];
      const double distance =
          squaredDistance(first_.estimated[i].values, second_.estimated[j].values, size_);
      (*of_first)[i].offer(j, distance);
      (*of_second)[j].offer(i, distance);
    }
  }

 private:
  // Estimates of all pairs, 64 MB; where there are more each row is estimated when it is asked for.
  static constexpr std::size_t kLargestMatrix = std::size_t{1} << 24;

  // Of rows first to first + count. Pairs that may not match get NaN, with which nothing compares.
  void estimate(std::size_t first, std::size_t count) {
    estimateDistances(first_.estimated.data() + first, count,
                      {columns_.values.data(), columns_.squares.data(),
                       static_cast<std::size_t>(size_), columns_.count},
                      estimates_.data());
    for (std::size_t i = 0; i < count; ++i) {
      float* const row = estimates_.data() + i * columns_.count;
      if (!estimates_anything_) {
        std::fill_n(row, second_.rows.size(), 0.0F);  // every distance is measured
      }
      for (std::size_t j = 0; rules_.may_match && j < second_.rows.size(); ++j) {
        if (!rules_.may_match(static_cast<std::size_t>(first_.rows[first + i]),
                              static_cast<std::size_t>(second_.rows[j]))) {
          row[j] = std::numeric_limits<float>::quiet_NaN();
        }
      }
    }
  }

  // Until the next call.
  const float* estimatesOf(std::size_t i) {
    if (keeps_all_) {
      return estimates_.data() + i * columns_.count;
    }
    estimate(i, 1);
    return estimates_.data();
  }

  // From the lowest estimate of every row and column.
  void findLimits() {
    second_limits_.assign(columns_.count, std::numeric_limits<float>::infinity());
    first_limits_.resize(first_.rows.size());
    for (std::size_t i = 0; i < first_.rows.size(); ++i) {
      first_limits_[i] =
          takeLowest(estimatesOf(i), columns_.count, second_limits_.data()) + margin_;
    }
    for (float& limit : second_limits_) {
      limit += margin_;
    }
  }

  // From the second lowest.
  void findSecondLimits() {
    std::vector<SmallestTwo> of_second(columns_.count);
    first_limits_.resize(first_.rows.size());
    for (std::size_t i = 0; i < first_.rows.size(); ++i) {
      const float* const row = estimatesOf(i);
      SmallestTwo of_first;
      for (std::size_t j = 0; j < second_.rows.size(); ++j) {
        of_first.offer(row[j]);
        of_second[j].offer(row[j]);
      }
      first_limits_[i] = of_first.second + margin_;
    }
    second_limits_.resize(columns_.count);
    for (std::size_t j = 0; j < columns_.count; ++j) {
      second_limits_[j] = of_second[j].second + margin_;
    }
  }

  const FiniteRows& first_;
  const FiniteRows& second_;
  int size_;
  const MatchingRules& rules_;
  Columns columns_;
  bool estimates_anything_;
  float margin_;
  bool keeps_all_;
  std::vector<float> estimates_;
  std::vector<float> first_limits_;
  std::vector<float> second_limits_;
  std::vector<std::uint32_t> places_;
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
  const FiniteRows first_rows(first);
  const FiniteRows second_rows(second);
  CandidatePairs candidates(first_rows, second_rows, first.cols, rules);
  const auto offer = [&](std::size_t i, auto* of_first, auto* of_second) {
    candidates.offer(i, of_first, of_second);
  };
  LineMatches matches;
  for (const NearestPair& pair : pairNearest(first_rows.rows, second_rows.rows, rules, offer)) {
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
