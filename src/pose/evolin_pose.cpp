// Rounds of damped least squares over matched lines, each from the identity, with a gate that
// closes from round to round.
//
// Minimises over T the sum over active matches and their two points X of huber((l . project(T
// X))^2) with l = p1 x p2 in pixels (Ivanov, Ferrer, Kornilova 2023, section on relative pose);
// damping as in g2o (Kuemmerle et al. 2011) after Nielsen 1999.
#include "evolin_ros/pose/evolin_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "line_residual.h"
#include "rigid_motion.h"

namespace evolin {

namespace {

struct Observation {
  Eigen::Vector3d line;
  std::array<Eigen::Vector3d, 2> points;  ///< in the source frame
  std::array<double, 2> residuals{};      ///< of the last motion tried
  std::size_t place = 0;                  ///< of its match
};

/// Cost and normal equations of the current motion.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d right_side = Vector6d::Zero();
};

class Solver {
 public:
  Solver(const EvolinPoseOptions& options, const Camera& camera, std::vector<Observation> active)
      : options_(options), camera_(camera), active_(std::move(active)) {}

  /// Runs the schedule to its end.
  void run() {
    bool huber = true;
    bool changed = true;
    for (int round = 0; round < options_.rounds; ++round) {
      // A round from the same start over the same matches ends in the same place.
      if (changed) {
        optimise(huber);
      }
      const std::size_t before = active_.size();
      const double gate = options_.first_gate / ((round + 1.0) * (round + 1.0));
      active_.erase(std::remove_if(active_.begin(), active_.end(),
                                   [gate](const Observation& observation) {
                                     const auto& e = observation.residuals;
                                     return (e[0] * e[0] + e[1] * e[1]) / 2 > gate;
                                   }),
                    active_.end());
      changed = active_.size() != before;
      if (round == options_.rounds - 2) {
        huber = false;
        changed = true;
      }
      if (active_.size() < options_.min_active) {
        return;
      }
    }
  }

  const std::vector<Observation>& active() const { return active_; }
  const Pose& motion() const { return motion_; }
  int iterations() const { return iterations_; }

  /// Covariance of the motion from the active matches, scaled by their residuals.
  Matrix6d covariance() {
    const double squares = evaluate(motion_, false);
    const double freedom = 2.0 * static_cast<double>(active_.size()) - 6;
    const Eigen::LLT<Matrix6d> factor(linearise(motion_, false).hessian);
    if (!(freedom > 0) || factor.info() != Eigen::Success) {
      return Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    return squares / freedom * factor.solve(Matrix6d::Identity());
  }

 private:
  double cost(double residual, bool huber) const {
    const double magnitude = std::abs(residual);
    const double delta = options_.huber_delta;
    return huber && magnitude > delta ? delta * (2 * magnitude - delta) : residual * residual;
  }

  /// Sum of costs; leaves the residuals behind.
  double evaluate(const Pose& motion, bool huber) {
    const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
    double sum = 0;
    for (Observation& observation : active_) {
      for (std::size_t end = 0; end < 2; ++end) {
        const Eigen::Vector3d point = rotation * observation.points[end] + motion.translation;
        const double residual = lineResidual(observation.line, camera_, point);
        observation.residuals[end] = residual;
        sum += cost(residual, huber);
      }
    }
    return sum;
  }

  /// The residuals are those of `motion`. Huber enters as a weight alone.
  NormalEquations linearise(const Pose& motion, bool huber) const {
    const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
    NormalEquations equations;
    for (const Observation& observation : active_) {
      for (std::size_t end = 0; end < 2; ++end) {
        const Eigen::Vector3d point = rotation * observation.points[end] + motion.translation;
        const double residual = observation.residuals[end];
        const Vector6d jacobian =
            lineResidualJacobian(point, lineResidualGradient(observation.line, camera_, point))
                .transpose();
        const double magnitude = std::abs(residual);
        const double weight =
            huber && magnitude > options_.huber_delta ? options_.huber_delta / magnitude : 1.0;
        equations.hessian.noalias() += (weight * jacobian) * jacobian.transpose();
        equations.right_side.noalias() -= weight * residual * jacobian;
      }
    }
    return equations;
  }

  void optimise(bool huber) {
    motion_ = Pose();
    double lambda = 0;
    double growth = 2;
    for (int step = 0; step < options_.steps; ++step) {
      double current = evaluate(motion_, huber);
      const NormalEquations equations = linearise(motion_, huber);
      if (step == 0) {
        constexpr double kInitialDamping = 1e-5;
        lambda = kInitialDamping * equations.hessian.diagonal().cwiseAbs().maxCoeff();
      }
      double gain = 0;
      int trial = 0;
      do {
        const auto [accepted, ratio] = tryStep(equations, lambda, current, huber);
        gain = ratio;
        if (accepted) {
          const double easing = 1 - std::pow(2 * gain - 1, 3);
          lambda *= std::max(1.0 / 3, std::min(2.0 / 3, easing));
          growth = 2;
        } else {
          lambda *= growth;
          growth *= 2;
          if (!std::isfinite(lambda)) {
            return;
          }
        }
        ++trial;
      } while (gain < 0 && trial < options_.trials);
      if (trial == options_.trials || gain == 0) {
        return;
      }
    }
  }

  /// Moves when the cost falls; whether it did, and the gain ratio.
  std::pair<bool, double> tryStep(const NormalEquations& equations, double lambda, double current,
                                  bool huber) {
    ++iterations_;
    Matrix6d damped = equations.hessian;
    damped.diagonal().array() += lambda;
    const Eigen::LLT<Matrix6d> factor(damped);
    if (factor.info() != Eigen::Success) {
      return {false, -std::numeric_limits<double>::infinity()};
    }
    const Vector6d step = factor.solve(equations.right_side);
    const Pose candidate = compose(expMotion(step), motion_);
    const double tried = evaluate(candidate, huber);
    // The constant keeps the ratio defined at the optimum.
    const double predicted = step.dot(lambda * step + equations.right_side) + 1e-3;
    const double gain = (current - tried) / predicted;
    const bool accepted = gain > 0 && std::isfinite(tried);
    if (accepted) {
      motion_ = candidate;
    }
    return {accepted, gain};
  }

  const EvolinPoseOptions& options_;
  const Camera& camera_;
  std::vector<Observation> active_;
  Pose motion_;
  int iterations_ = 0;
};

void require(bool ok, const std::string& key, double value, const std::string& expectation) {
  if (!ok) {
    throw ConfigError("relative pose (evolin)", key,
                      formatDouble(value) + ", expected " + expectation);
  }
}

}  // namespace

void validate(const EvolinPoseOptions& options) {
  require(options.rounds >= 1, "rounds", options.rounds, "at least 1");
  require(options.steps >= 1, "steps", options.steps, "at least 1");
  require(options.trials >= 1, "trials", options.trials, "at least 1");
  require(options.huber_delta > 0 && std::isfinite(options.huber_delta), "huber_delta",
          options.huber_delta, "a finite number above 0");
  require(options.first_gate > 0 && std::isfinite(options.first_gate), "first_gate",
          options.first_gate, "a finite number above 0");
  require(options.min_active >= 3, "min_active", static_cast<double>(options.min_active),
          "at least 3");
}

EvolinPoseEstimator::EvolinPoseEstimator(const EvolinPoseOptions& options) : options_(options) {
  validate(options_);
}

RelativePose EvolinPoseEstimator::estimate(const SpatialMatches& matches,
                                           const Camera& camera) const {
  constexpr std::size_t kFewestMatches = 3;
  RelativePose result;
  std::vector<Observation> observations;
  observations.reserve(matches.size());
  for (std::size_t place = 0; place < matches.size(); ++place) {
    Observation observation;
    observation.line = imageLine(matches[place].first, options_.normalised);
    observation.points = {matches[place].second.point1, matches[place].second.point2};
    observation.place = place;
    // Only a segment without length, normalised, has none; it says nothing.
    if (observation.line.allFinite()) {
      observations.push_back(observation);
    }
  }
  if (observations.size() < kFewestMatches) {
    result.failure = PoseFailure::kTooFewMatches;
    result.reason =
        std::to_string(observations.size()) + " matches with depth, expected at least 3";
    return result;
  }
  Solver solver(options_, camera, std::move(observations));
  solver.run();
  result.iterations = solver.iterations();
  result.first_to_second = inverse(solver.motion());
  if (!isFinite(result.first_to_second)) {
    result.first_to_second = Pose();
    result.failure = PoseFailure::kNotFinite;
    result.reason = "the least squares ran away to numbers that are not finite";
    return result;
  }
  for (const Observation& observation : solver.active()) {
    result.inliers.push_back(observation.place);
  }
  result.ill_conditioned = solver.active().size() < options_.min_active;
  // The motion solved for is the inverse: exp(d) T = (T' exp(-d))^-1.
  const Matrix6d change = adjoint(result.first_to_second);
  result.covariance = change * solver.covariance() * change.transpose();
  return result;
}

}  // namespace evolin
