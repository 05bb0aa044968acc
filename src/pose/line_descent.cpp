// Steps over the sums of line_sums.h.
#include "line_descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evolin {

namespace {

/// Where the Huber kernel is off; its square is finite.
constexpr double kNoHuber = 1e100;

Matrix6d hessianOf(const LineSums& sums) {
  Matrix6d hessian;
  int next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      hessian(row, column) = sums.hessian[next];
      hessian(column, row) = sums.hessian[next++];
    }
  }
  return hessian;
}

double largestDiagonal(const LineSums& sums) {
  double largest = 0;
  int next = 0;
  for (int row = 0; row < 6; ++row) {
    largest = std::max(largest, std::abs(sums.hessian[next]));
    next += 6 - row;
  }
  return largest;
}

/// Solves (H + lambda I) step = right side by the factors L D L^T; false when the matrix is not
/// positive definite.
bool solveDamped(const LineSums& sums, double lambda, Vector6d* step) {
  double lower[6][6];
  double diagonal[6];
  double inverse[6];
  int next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      lower[column][row] = sums.hessian[next++];
    }
  }
  for (int column = 0; column < 6; ++column) {
    double pivot = lower[column][column] + lambda;
    for (int k = 0; k < column; ++k) {
      pivot -= lower[column][k] * lower[column][k] * diagonal[k];
    }
    if (pivot <= 0) {
      return false;
    }
    diagonal[column] = pivot;
    inverse[column] = 1 / pivot;
    for (int row = column + 1; row < 6; ++row) {
      double value = lower[row][column];
      for (int k = 0; k < column; ++k) {
        value -= lower[row][k] * lower[column][k] * diagonal[k];
      }
      lower[row][column] = value * inverse[column];
    }
  }
  double x[6];
  for (int row = 0; row < 6; ++row) {
    x[row] = sums.right_side[row];
    for (int k = 0; k < row; ++k) {
      x[row] -= lower[row][k] * x[k];
    }
  }
  for (int row = 5; row >= 0; --row) {
    x[row] *= inverse[row];
    for (int k = row + 1; k < 6; ++k) {
      x[row] -= lower[k][row] * x[k];
    }
    (*step)[row] = x[row];
  }
  return true;
}

}  // namespace

LineDescent::LineDescent(const EvolinPoseOptions& options, LineTable* table)
    : options_(options), table_(table) {}

LineSums LineDescent::sumUp(const Pose& motion, double delta) {
  const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
  LineMotion line_motion;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      line_motion.rotation[3 * row + column] = rotation(row, column);
    }
    line_motion.translation[row] = motion.translation[row];
  }
  if (std::exchange(keep_, false)) {
    table_->keepResiduals();
  }
  LineSums sums;
  lineSums(table_->view(), line_motion, delta, &sums);
  return sums;
}

void LineDescent::start(bool huber) {
  constexpr double kInitialDamping = 1e-5;
  delta_ = huber ? options_.huber_delta : kNoHuber;
  motion_ = Pose();
  sums_ = sumUp(motion_, delta_);
  lambda_ = kInitialDamping * largestDiagonal(sums_);
  growth_ = 2;
  steps_ = 0;
  finished_ = false;
}

void LineDescent::step() {
  keep_ = true;
  std::copy_backward(predicted_, predicted_ + 2, predicted_ + 3);
  double gain = 0;
  int trial = 0;
  do {
    const Trial tried = tryStep();
    gain = tried.gain;
    if (tried.accepted) {
      const double twice = 2 * gain - 1;
      lambda_ *= std::max(1.0 / 3, std::min(2.0 / 3, 1 - twice * twice * twice));
      growth_ = 2;
    } else {
      lambda_ *= growth_;
      growth_ *= 2;
      if (!std::isfinite(lambda_)) {
        finished_ = true;
        return;
      }
    }
    ++trial;
  } while (gain < 0 && trial < options_.trials);
  straight_ = trial == 1;
  ++steps_;
  finished_ = trial == options_.trials || gain == 0 || steps_ == options_.steps;
}

/// Moves when the cost falls.
LineDescent::Trial LineDescent::tryStep() {
  ++iterations_;
  Vector6d step;
  if (!solveDamped(sums_, lambda_, &step)) {
    return {false, -std::numeric_limits<double>::infinity()};
  }
  const Pose candidate = compose(expMotion(step), motion_);
  const LineSums tried = sumUp(candidate, delta_);
  const Eigen::Map<const Vector6d> right_side(sums_.right_side);
  predicted_[0] = step.dot(lambda_ * step + right_side);
  // The constant keeps the ratio defined at the optimum.
  const double gain = (sums_.cost - tried.cost) / (predicted_[0] + 1e-3);
  const bool accepted = gain > 0 && std::isfinite(tried.cost);
  if (accepted) {
    motion_ = candidate;
    sums_ = tried;
  }
  return {accepted, gain};
}

/// How many steps like the last one are as long as all that are left, and some margin.
double LineDescent::stepsToReach() const {
  constexpr double kMargin = 4;
  constexpr double kMarginOfSeries = 8;
  constexpr double kSlowest = 0.97;
  // With few of them the steps shrink less evenly; they take little time.
  constexpr std::size_t kManyMatches = 30;
  const double all = kMargin * (options_.steps - steps_);
  // The gain that is predicted goes with the square of a step.
  const double ratio =
      std::sqrt(std::max(predicted_[0] / predicted_[1], predicted_[1] / predicted_[2]));
  // Also where the ratio is not a number.
  if (table_->size() < kManyMatches || !(ratio < kSlowest)) {
    return all;
  }
  return std::min(all, kMarginOfSeries * ratio / (1 - ratio));
}

bool LineDescent::isSettled(double gate) {
  constexpr int kFirstLook = 4;
  // A residual that stands still while others move may move again.
  constexpr double kShareOfLargest = 0.1;
  if (steps_ < kFirstLook || !straight_) {
    return false;
  }
  const double left = stepsToReach();
  if (!table_->canTell(gate, left, 0)) {
    return false;
  }
  return table_->canTell(gate, left, kShareOfLargest * table_->largestChange()) &&
         table_->countWithin(gate) >= options_.min_active;
}

Matrix6d LineDescent::covariance() {
  const LineSums sums = sumUp(motion_, kNoHuber);
  const double freedom = 2.0 * static_cast<double>(table_->size()) - 6;
  const Eigen::LLT<Matrix6d> factor(hessianOf(sums));
  if (!(freedom > 0) || factor.info() != Eigen::Success) {
    return Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return sums.cost / freedom * factor.solve(Matrix6d::Identity());
}

}  // namespace evolin
