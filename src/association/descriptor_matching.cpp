// Matching of descriptors by nearest neighbour.
#include "evolin_ros/association/descriptor_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

struct Nearest {
  std::size_t index = kNobody;
  double squared_distance = std::numeric_limits<double>::infinity();

  void offer(std::size_t candidate, double distance) {
    if (distance < squared_distance) {
      squared_distance = distance;
      index = candidate;
    }
  }
};

void requireDescriptors(const cv::Mat& descriptors, const char* which) {
  if (descriptors.rows > 0 && descriptors.type() != CV_32F) {
    throw Error(std::string("descriptor matching: the ") + which + " matrix has OpenCV type " +
                std::to_string(descriptors.type()) + ", expected CV_32F with one channel");
  }
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
  requireDescriptors(first, "first");
  requireDescriptors(second, "second");
  if (first.rows == 0 || second.rows == 0) {
    return {};
  }
  if (first.cols != second.cols) {
    throw Error("descriptor matching: descriptors of " + std::to_string(first.cols) + " and of " +
                std::to_string(second.cols) + " values, expected equal sizes");
  }
  const std::vector<int> first_rows = finiteRows(first);
  const std::vector<int> second_rows = finiteRows(second);
  const std::vector<double> columns = transposed(second, second_rows);

  std::vector<Nearest> of_first(first_rows.size());
  std::vector<Nearest> of_second(second_rows.size());
  std::vector<double> distances(second_rows.size());
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    squaredDistances(first.ptr<float>(first_rows[i]), first.cols, columns, &distances);
    for (std::size_t j = 0; j < distances.size(); ++j) {
      of_first[i].offer(j, distances[j]);
      of_second[j].offer(i, distances[j]);
    }
  }

  LineMatches matches;
  for (std::size_t i = 0; i < first_rows.size(); ++i) {
    const Nearest& nearest = of_first[i];
    if (nearest.index == kNobody || (cross_check && of_second[nearest.index].index != i)) {
      continue;  // nobody to match, or that one prefers another
    }
    LineMatch match;
    match.first = static_cast<std::uint32_t>(first_rows[i]);
    match.second = static_cast<std::uint32_t>(second_rows[nearest.index]);
    match.distance = static_cast<float>(std::sqrt(nearest.squared_distance));
    matches.push_back(match);
  }
  return matches;
}

}  // namespace evolin
