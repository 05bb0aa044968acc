// The matches that a relative pose is sought from, laid out for lineSums().
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "line_sums.h"

namespace evolin {

class LineTable {
 public:
  explicit LineTable(std::size_t capacity);

  /// A match: two points in the source frame, metres, and the image line in the target frame.
  /// `place` is given back by places(). Not beyond the capacity.
  void add(const Eigen::Vector3d& point1, const Eigen::Vector3d& point2,
           const Eigen::Vector3d& line, const Camera& camera, std::size_t place);

  std::size_t size() const { return places_.size(); }
  const std::vector<std::size_t>& places() const { return places_; }

  /// Mean of the squares of a match's two residuals, as lineSums() left them.
  double meanSquare(std::size_t row) const {
    const double* const first = residuals(0);
    const double* const second = residuals(1);
    return (first[row] * first[row] + second[row] * second[row]) / 2;
  }

  /// Takes out the matches whose mean square is above `gate`; the others keep their order.
  void removeAbove(double gate);

  std::size_t countWithin(double gate) const;

  /// Remembers the residuals as they are, for the following two; they are undefined then until
  /// lineSums() makes new ones.
  void keepResiduals();

  /// Of a residual since then.
  double largestChange() const;

  /// Whether every match stays on its side of `gate` if each of its residuals moves, either way, by
  /// `times` its change since then, and by `times` `change` at least.
  bool canTell(double gate, double times, double change);

  /// For lineSums(); valid until the table changes or residuals are kept.
  LineTableView view();

 private:
  /// Of all first points (0) or all second ones (1).
  const double* residuals(int end) const { return column(kResidual1 + 2 * newest_ + end); }
  const double* keptResiduals(int end) const {
    return column(kResidual1 + 2 * (1 - newest_) + end);
  }

  double* column(int index) { return values_.data() + static_cast<std::size_t>(index) * stride_; }
  const double* column(int index) const {
    return values_.data() + static_cast<std::size_t>(index) * stride_;
  }

  std::size_t stride_;          ///< of a column
  std::vector<double> values_;  ///< columns as in LineColumn, and two more for kept residuals
  int newest_ = 0;              ///< of the two pairs of columns for residuals, the other being kept
  std::size_t open_ = 0;        ///< the row that could not be told last: likely the next as well
  std::vector<std::size_t> places_;
};

}  // namespace evolin
