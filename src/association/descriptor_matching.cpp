// Matching of descriptors by nearest neighbour.
#include "evolin_ros/association/descriptor_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/hal.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

struct Nearest {
  std::size_t index = kNobody;
  double distance = std::numeric_limits<double>::infinity();

  void offer(std::size_t candidate, double candidate_distance) {
    if (candidate_distance < distance) {
      distance = candidate_distance;
      index = candidate;
    }
  }
};

struct NearestPair {
  int first;
  int second;
  double distance;
};

// Pairs of nearest rows among those chosen, by the first. `measure(i, &distances)` fills the
// distances of first_rows[i] from all of `second_rows`.
template <typename Measure>
std::vector<NearestPair> pairNearest(const std::vector<int>& first_rows,
                                     const std::vector<int>& second_rows, bool cross_check,
                                     Measure measure) {
  std::vector<Nearest> of_first(first_rows.size());
  std::vector<Nearest> of_second(second_rows.size());
  std::vector<double> distances(second_rows.size());
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    measure(i, &distances);
    for (std::size_t j = 0; j < distances.size(); ++j) {
      of_first[i].offer(j, distances[j]);
      of_second[j].offer(i, distances[j]);
    }
  }
  std::vector<NearestPair> pairs;
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    const Nearest& nearest = of_first[i];
    if (nearest.index == kNobody || (cross_check && of_second[nearest.index].index != i)) {
      continue;  // nobody to match, or that one prefers another
    }
    pairs.push_back({first_rows[i], second_rows[nearest.index], nearest.distance});
  }
  return pairs;
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

// The chosen rows as the columns of a matrix in double precision: distances to many descriptors
// are then summed side by side.
std::vector<double> transposed(const cv::Mat& descriptors, const std::vector<int>& rows) {
  std::vector<double> columns(rows.size() * static_cast<std::size_t>(descriptors.cols));
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const float* const row = descriptors.ptr<float>(rows[j]);
    for (int d = 0; d < descriptors.cols; ++d) {
      columns[static_cast<std::size_t>(d) * rows.size() + j] = row[d];
    }
  }
  return columns;
}

void squaredDistances(const float* descriptor, int size, const std::vector<double>& columns,
                      std::vector<double>* distances) {
  const std::size_t count = distances->size();
  double* const sums = distances->data();
  std::fill(distances->begin(), distances->end(), 0.0);
  for (int d = 0; d < size; ++d) {
    const double value = descriptor[d];
    const double* const column = columns.data() + static_cast<std::size_t>(d) * count;
    for (std::size_t j = 0; j < count; ++j) {
      const double difference = value - column[j];
      sums[j] += difference * difference;
    }
  }
}

}  // namespace

LineMatches matchDescriptors(const cv::Mat& first, const cv::Mat& second, bool cross_check) {
  requireType(first, "first", CV_32F, "CV_32F");
  requireType(second, "second", CV_32F, "CV_32F");
  if (first.rows == 0 || second.rows == 0) {
    return {};
  }
  requireEqualWidth(first, second);
  const std::vector<int> first_rows = finiteRows(first);
  const std::vector<int> second_rows = finiteRows(second);
  const std::vector<double> columns = transposed(second, second_rows);
  const auto measure = [&](std::size_t i, std::vector<double>* distances) {
    squaredDistances(first.ptr<float>(first_rows[i]), first.cols, columns, distances);
  };
  LineMatches matches;
  for (const NearestPair& pair : pairNearest(first_rows, second_rows, cross_check, measure)) {
    matches.push_back(makeMatch(pair, std::sqrt(pair.distance)));
  }
  return matches;
}

LineMatches matchBinaryDescriptors(const BinaryDescriptors& first, const BinaryDescriptors& second,
                                   bool cross_check, int max_distance) {
  requireBits(first, "first");
  requireBits(second, "second");
  if (first.bits.rows == 0 || second.bits.rows == 0) {
    return {};
  }
  requireEqualWidth(first.bits, second.bits);
  const std::vector<int> first_rows = validRows(first);
  const std::vector<int> second_rows = validRows(second);
  const auto measure = [&](std::size_t i, std::vector<double>* distances) {
    const std::uint8_t* const row = first.bits.ptr<std::uint8_t>(first_rows[i]);
    for (std::size_t j = 0; j < second_rows.size(); ++j) {
      (*distances)[j] =
          cv::hal::normHamming(row, second.bits.ptr<std::uint8_t>(second_rows[j]), first.bits.cols);
    }
  };
  LineMatches matches;
  for (const NearestPair& pair : pairNearest(first_rows, second_rows, cross_check, measure)) {
    if (pair.distance <= max_distance) {
      matches.push_back(makeMatch(pair, pair.distance));
    }
  }
  return matches;
}

}  // namespace evolin
