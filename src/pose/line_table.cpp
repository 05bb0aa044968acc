// Columns of doubles, padded with matches that add nothing.
#include "line_table.h"

#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

std::size_t padded(std::size_t rows) { return (rows + kLineLanes - 1) / kLineLanes * kLineLanes; }

}  // namespace

LineTable::LineTable(std::size_t capacity)
    : stride_(padded(capacity)), values_(stride_ * (kLineColumns + 2)) {
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
                        line.x() * camera.cx + line.y() * camera.cy + line.z()};
  for (int i = 0; i < kResidual1; ++i) {
    column(i)[size()] = row[i];
  }
  places_.push_back(place);
}

void LineTable::removeAbove(double gate) {
  std::size_t kept = 0;
  while (kept < size() && !(meanSquare(kept) > gate)) {
    ++kept;
  }
  for (std::size_t row = kept; row < size(); ++row) {
    if (meanSquare(row) > gate) {
      continue;
    }
    for (int i = 0; i < kLineColumns + 2; ++i) {
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

void LineTable::keepResiduals() { newest_ = 1 - newest_; }

double LineTable::largestChange() const {
  double largest = 0;
  for (const int end : {0, 1}) {
    for (std::size_t row = 0; row < size(); ++row) {
      largest = std::max(largest, std::abs(residuals(end)[row] - keptResiduals(end)[row]));
    }
  }
  return largest;
}

bool LineTable::canTell(double gate, double times, double change) {
  const double* const residuals1 = residuals(0);
  const double* const residuals2 = residuals(1);
  const double* const kept1 = keptResiduals(0);
  const double* const kept2 = keptResiduals(1);
  const auto stays = [&](std::size_t row) {
    const double size1 = std::abs(residuals1[row]);
    const double size2 = std::abs(residuals2[row]);
    const double reach1 = times * std::max(std::abs(residuals1[row] - kept1[row]), change);
    const double reach2 = times * std::max(std::abs(residuals2[row] - kept2[row]), change);
    const double nearest1 = std::max(size1 - reach1, 0.0);
    const double nearest2 = std::max(size2 - reach2, 0.0);
    const double most = (size1 + reach1) * (size1 + reach1) + (size2 + reach2) * (size2 + reach2);
    const double least = nearest1 * nearest1 + nearest2 * nearest2;
    return most / 2 <= gate || least / 2 > gate;
  };
  if (open_ < size() && !stays(open_)) {
    return false;
  }
  for (std::size_t row = 0; row < size(); ++row) {
    if (!stays(row)) {
      open_ = row;
      return false;
    }
  }
  return true;
}

LineTableView LineTable::view() {
  LineTableView table;
  table.rows = padded(size());
  for (int i = 0; i < kResidual1; ++i) {
    table.columns[i] = column(i);
    for (std::size_t row = size(); row < table.rows; ++row) {
      // In front of the camera for any motion that is not far off.
      column(i)[row] = i == kPoint1Z || i == kPoint2Z ? 1 : 0;
    }
  }
  table.columns[kResidual1] = column(kResidual1 + 2 * newest_);
  table.columns[kResidual2] = column(kResidual2 + 2 * newest_);
  return table;
}

}  // namespace evolin
