// Columns of doubles, padded with matches that add nothing.
#include "line_table.h"

#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

std::size_t padded(std::size_t rows) { return (rows + kLineLanes - 1) / kLineLanes * kLineLanes; }

}  // namespace

LineTable::LineTable(std::size_t capacity)
    : stride_(padded(capacity)), values_(stride_ * kLineColumns), kept_(2 * stride_) {
  places_.reserve(capacity);
}

void LineTable::add(const Eigen::Vector3d& point1, const Eigen::Vector3d& point2,
                    const Eigen::Vector3d& line, const Camera& camera, std::size_t place) {
  const double row[] = {point1.x(),
                        point1.y(),
                        point1.z(),
                        point2.x(),
                        point2.y(),
                        point2.z(),
                        line.x() * camera.fx,
                        line.y() * camera.fy,
                        line.x() * camera.cx + line.y() * camera.cy + line.z(),
                        0,
                        0};
  for (int i = 0; i < kLineColumns; ++i) {
    column(i)[size()] = row[i];
  }
  places_.push_back(place);
}

void LineTable::removeAbove(double gate) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < size(); ++row) {
    if (meanSquare(row) > gate) {
      continue;
    }
    for (int i = 0; i < kLineColumns; ++i) {
      column(i)[kept] = column(i)[row];
    }
    places_[kept++] = places_[row];
  }
  places_.resize(kept);
}

std::size_t LineTable::countWithin(double gate) const {
  std::size_t count = 0;
  for (std::size_t row = 0; row < size(); ++row) {
    count += meanSquare(row) > gate ? 0 : 1;
  }
  return count;
}

void LineTable::keepResiduals() {
  std::copy_n(column(kResidual1), size(), kept_.data());
  std::copy_n(column(kResidual2), size(), kept_.data() + stride_);
}

double LineTable::largestChange() const {
  double largest = 0;
  for (std::size_t row = 0; row < size(); ++row) {
    largest = std::max({largest, std::abs(column(kResidual1)[row] - kept_[row]),
                        std::abs(column(kResidual2)[row] - kept_[stride_ + row])});
  }
  return largest;
}

bool LineTable::canTell(double gate, double times, double change) const {
  const auto square = [](double value) { return value * value; };
  for (std::size_t row = 0; row < size(); ++row) {
    const double first = column(kResidual1)[row];
    const double second = column(kResidual2)[row];
    const double reach1 = times * std::max(std::abs(first - kept_[row]), change);
    const double reach2 = times * std::max(std::abs(second - kept_[stride_ + row]), change);
    const double most = square(std::abs(first) + reach1) + square(std::abs(second) + reach2);
    const double least = square(std::max(std::abs(first) - reach1, 0.0)) +
                         square(std::max(std::abs(second) - reach2, 0.0));
    if (!(most / 2 <= gate || least / 2 > gate)) {
      return false;
    }
  }
  return true;
}

LineTableView LineTable::view() {
  LineTableView table;
  table.rows = padded(size());
  for (int i = 0; i < kLineColumns; ++i) {
    table.columns[i] = column(i);
    for (std::size_t row = size(); row < table.rows; ++row) {
      // In front of the camera for any motion that is not far off.
      column(i)[row] = i == kPoint1Z || i == kPoint2Z ? 1 : 0;
    }
  }
  return table;
}

}  // namespace evolin
