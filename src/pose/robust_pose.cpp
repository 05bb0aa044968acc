// Consensus over samples of two lines with local optimisation (Fischler and Bolles 1981; Chum,
// Matas and Kittler 2003), scored by truncated squared distances in both images (Torr and Zisserman
// 2000), then least squares with a Cauchy loss on what agrees.
#include "evolin_ros/pose/robust_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "line_alignment.h"
#include "line_conditioning.h"
#include "pose_refinement.h"
#include "two_view_line.h"

namespace evolin {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180;

/// A motion with what speaks for it.
struct Hypothesis {
  Pose motion;
  double cost = std::numeric_limits<double>::infinity();
  std::vector<Support> support;
};

std::size_t countSupported(const std::vector<Support>& support) {
  return static_cast<std::size_t>(
      std::count_if(support.begin(), support.end(), [](const Support& s) { return s.any(); }));
}

class Search {
 public:
  Search(const RobustPoseOptions& options, const Camera& camera,
         const std::vector<TwoViewLine>& lines)
      : options_(options), camera_(camera), lines_(lines), generator_(options.seed) {}

  /// The best motion found; no support when no sample gave one.
  Hypothesis run() {
    Hypothesis best;
    int needed = options_.max_samples;
    for (int sample = 0; sample < needed; ++sample) {
      const std::size_t a = draw(lines_.size());
      std::size_t b = draw(lines_.size() - 1);
      b += b >= a ? 1 : 0;
      ++iterations_;
      for (const Pose& motion : align(lines_[a], lines_[b])) {
        if (Hypothesis candidate; judge(motion, best.cost, &candidate)) {
          best = std::move(candidate);
          improve(&best);
          needed = std::clamp(samplesFor(countSupported(best.support)), options_.min_samples,
                              options_.max_samples);
        }
      }
    }
    return best;
  }

  /// Least squares on the support, again while that gains any.
  void refine(Hypothesis* best) {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const Refinement refined = refineMotion(lines_, best->support, best->motion, camera_,
                                              options_.loss_scale, options_.refinement_steps);
      iterations_ += refined.iterations;
      if (!refined.usable) {
        return;
      }
      const std::vector<Support> before = best->support;
      *best = supportOf(refined.motion);
      const bool settled = std::equal(before.begin(), before.end(), best->support.begin(),
                                      [](const Support& x, const Support& y) {
                                        return x.forward == y.forward && x.backward == y.backward;
                                      });
      if (settled) {
        return;
      }
    }
  }

  int iterations() const { return iterations_; }

 private:
  /// Uniform in [0, count). The standard's distributions differ from library to library, and the
  /// bias of the remainder is far below one in 2^32.
  std::size_t draw(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }

  std::vector<Pose> align(const TwoViewLine& a, const TwoViewLine& b) const {
    // Depth noise turns short lines by several degrees; wrong pairs differ by more.
    constexpr double kMaxAngleDifference = 15 * kDegree;
    const auto line = [](const PointsOnLine& seen, const Eigen::Vector3d& direction) {
      return DirectedLine{(seen.points[0] + seen.points[1]) / 2, direction};
    };
    return alignLines(line(a.forward, a.direction1), line(b.forward, b.direction1),
                      line(a.backward, a.direction2), line(b.backward, b.direction2),
                      options_.min_angle * kDegree, kMaxAngleDifference);
  }

  /// Scores `motion`; false, and early, when it costs as much as `limit`.
  bool judge(const Pose& motion, double limit, Hypothesis* scored) const {
    const double gate = options_.threshold * options_.threshold;
    const Eigen::Matrix3d there = motion.rotation.toRotationMatrix();
    const Eigen::Matrix3d back = there.transpose();
    const Eigen::Vector3d back_translation = -(back * motion.translation);
    double cost = 0;
    scored->support.resize(lines_.size());
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double forward = squaredDistance(lines_[i].forward, there, motion.translation, camera_);
      const double backward = squaredDistance(lines_[i].backward, back, back_translation, camera_);
      scored->support[i] = {forward <= gate, backward <= gate};
      cost += std::min(forward, gate) + std::min(backward, gate);
      if (cost >= limit) {
        return false;
      }
    }
    scored->motion = motion;
    scored->cost = cost;
    return true;
  }

  Hypothesis supportOf(const Pose& motion) const {
    Hypothesis scored;
    judge(motion, std::numeric_limits<double>::infinity(), &scored);
    return scored;
  }

  /// Weighted Gauss-Newton steps from wide to narrow, kept as far as they lower the cost.
  void improve(Hypothesis* best) {
    constexpr int kRepeats = 5;
    constexpr int kSteps = 4;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      Pose motion = best->motion;
      const double scale = options_.threshold / (repeat + 1);
      for (int i = 0; i < kSteps; ++i) {
        const WeightedEquations equations =
            sumEquations(lines_, best->support, motion, camera_, scale);
        const Eigen::LLT<Matrix6d> factor(equations.hessian);
        ++iterations_;
        if (factor.info() != Eigen::Success) {
          return;
        }
        motion = compose(expMotion(factor.solve(equations.right_side)), motion);
      }
      Hypothesis candidate;
      if (!isFinite(motion) || !judge(motion, best->cost, &candidate)) {
        return;
      }
      *best = std::move(candidate);
    }
  }

  /// Samples that contain one without a wrong match at the confidence asked for. Of samples of
  /// right matches, noise spoils most: several times as many are drawn.
  int samplesFor(std::size_t supported) const {
    constexpr double kSpoilt = 5;
    const double ratio = static_cast<double>(supported) / static_cast<double>(lines_.size());
    const double miss = std::log1p(-std::min(ratio * ratio, 1 - 1e-9));
    return static_cast<int>(std::min<double>(
        options_.max_samples, std::ceil(kSpoilt * std::log1p(-options_.confidence) / miss)));
  }

  const RobustPoseOptions& options_;
  const Camera& camera_;
  const std::vector<TwoViewLine>& lines_;
  std::mt19937_64 generator_;
  int iterations_ = 0;
};

RelativePose failure(PoseFailure kind, std::string reason, int iterations) {
  RelativePose result;
  result.failure = kind;
  result.reason = std::move(reason);
  result.iterations = iterations;
  return result;
}

/// Of the refined motion: inverse of the weighted normal equations, scaled by the residuals.
Matrix6d covarianceOf(const std::vector<TwoViewLine>& lines, const Hypothesis& best,
                      const Camera& camera, double scale) {
  const WeightedEquations equations = sumEquations(lines, best.support, best.motion, camera, scale);
  const Eigen::LLT<Matrix6d> factor(equations.hessian);
  const double freedom = equations.weights - 6;
  if (factor.info() != Eigen::Success || !(freedom > 0)) {
    return Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return equations.weighted_squares / freedom * factor.solve(Matrix6d::Identity());
}

void require(bool ok, const std::string& key, double value, const std::string& expectation) {
  if (!ok) {
    throw ConfigError("relative pose (robust)", key,
                      formatDouble(value) + ", expected " + expectation);
  }
}

}  // namespace

void validate(const RobustPoseOptions& options) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  require(positive(options.threshold), "threshold", options.threshold,
          "a finite number of pixels above 0");
  require(positive(options.loss_scale), "loss_scale", options.loss_scale,
          "a finite number of pixels above 0");
  require(options.confidence > 0 && options.confidence < 1, "confidence", options.confidence,
          "a number between 0 and 1");
  require(options.min_samples >= 1, "min_samples", options.min_samples, "at least 1");
  require(options.max_samples >= options.min_samples, "max_samples", options.max_samples,
          "at least min_samples, " + std::to_string(options.min_samples));
  require(options.min_inlier_ratio >= 0 && options.min_inlier_ratio <= 1, "min_inlier_ratio",
          options.min_inlier_ratio, "0 to 1");
  require(options.min_angle > 0 && options.min_angle < 90, "min_angle", options.min_angle,
          "a number of degrees between 0 and 90");
  require(options.refinement_steps >= 1, "refinement_steps", options.refinement_steps,
          "at least 1");
}

RobustPoseEstimator::RobustPoseEstimator(const RobustPoseOptions& options) : options_(options) {
  validate(options_);
}

RelativePose RobustPoseEstimator::estimate(const SpatialMatches& matches,
                                           const Camera& camera) const {
  constexpr std::size_t kFewestMatches = 3;
  constexpr std::size_t kComfortable = 6;
  const std::vector<TwoViewLine> lines = makeTwoViewLines(matches);
  if (lines.size() < kFewestMatches) {
    return failure(
        PoseFailure::kTooFewMatches,
        std::to_string(lines.size()) + " matches with depth and length, expected at least 3", 0);
  }
  Search search(options_, camera, lines);
  Hypothesis best = search.run();
  if (best.support.empty()) {
    return failure(PoseFailure::kDegenerate,
                   "no two of the " + std::to_string(lines.size()) +
                       " lines make one angle, above " + formatDouble(options_.min_angle) +
                       " degrees, in both frames: parallel lines, or none that match",
                   search.iterations());
  }
  search.refine(&best);
  const std::size_t supported = countSupported(best.support);
  const auto fewest = std::max<std::size_t>(
      kFewestMatches, static_cast<std::size_t>(std::ceil(options_.min_inlier_ratio *
                                                         static_cast<double>(lines.size()))));
  if (supported < fewest) {
    return failure(PoseFailure::kNoConsensus,
                   "at most " + std::to_string(supported) + " of " + std::to_string(lines.size()) +
                       " matches agree on a motion, expected at least " + std::to_string(fewest),
                   search.iterations());
  }
  if (const std::string open = openMotion(lines, best.support, best.motion, camera);
      !open.empty()) {
    return failure(PoseFailure::kDegenerate, open, search.iterations());
  }
  RelativePose result;
  result.first_to_second = best.motion;
  result.iterations = search.iterations();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (best.support[i].any()) {
      result.inliers.push_back(lines[i].place);
    }
  }
  result.covariance = covarianceOf(lines, best, camera, options_.loss_scale);
  result.ill_conditioned =
      supported < kComfortable || hangsOnOneLine(lines, best.support, best.motion, camera);
  return result;
}

}  // namespace evolin
