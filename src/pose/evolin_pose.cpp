// Rounds of damped least squares over matched lines, each from the identity, with a gate that
// closes from round to round.
//
// Minimises over T the sum over active matches and their two points X of huber((l . project(T
// X))^2) with l = p1 x p2 in pixels (Ivanov, Ferrer, Kornilova 2023, section on relative pose).
#include "evolin_ros/pose/evolin_pose.h"

#include <cmath>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "line_descent.h"
#include "line_residual.h"
#include "line_table.h"
#include "rigid_motion.h"

namespace evolin {

namespace {

/// Runs the schedule to its end; the matches that are active then stay in `active`.
void runRounds(const EvolinPoseOptions& options, LineTable* active, LineDescent* descent) {
  bool huber = true;
  bool changed = true;
  for (int round = 0; round < options.rounds; ++round) {
    // A round from the same start over the same matches ends in the same place.
    if (changed) {
      descent->start(huber);
    }
    // Of all rounds but the last only the matches that it leaves count.
    const double gate = options.first_gate / ((round + 1.0) * (round + 1.0));
    const bool last = round == options.rounds - 1;
    while (!descent->finished() && (last || !descent->isSettled(gate))) {
      descent->step();
    }
    const std::size_t before = active->size();
    active->removeAbove(gate);
    changed = active->size() != before;
    if (round == options.rounds - 2) {
      huber = false;
      changed = true;
    }
    if (active->size() < options.min_active) {
      return;
    }
  }
}

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
  LineTable lines(matches.size());
  for (std::size_t place = 0; place < matches.size(); ++place) {
    const Eigen::Vector3d line = imageLine(matches[place].first, options_.normalised);
    // Only a segment without length, normalised, has none; it says nothing.
    if (line.allFinite()) {
      lines.add(matches[place].second.point1, matches[place].second.point2, line, camera, place);
    }
  }
  if (lines.size() < kFewestMatches) {
    result.failure = PoseFailure::kTooFewMatches;
    result.reason = std::to_string(lines.size()) + " matches with depth, expected at least 3";
    return result;
  }
  LineDescent descent(options_, &lines);
  runRounds(options_, &lines, &descent);
  result.iterations = descent.iterations();
  result.first_to_second = inverse(descent.motion());
  if (!isFinite(result.first_to_second)) {
    result.first_to_second = Pose();
    result.failure = PoseFailure::kNotFinite;
    result.reason = "the least squares ran away to numbers that are not finite";
    return result;
  }
  result.inliers = lines.places();
  result.ill_conditioned = lines.size() < options_.min_active;
  // The motion solved for is the inverse: exp(d) T = (T' exp(-d))^-1.
  const Matrix6d change = adjoint(result.first_to_second);
  result.covariance = change * descent.covariance() * change.transpose();
  return result;
}

}  // namespace evolin
