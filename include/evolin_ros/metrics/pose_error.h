// Errors of estimated relative poses and their summary over pairs of frames (Ivanov, Ferrer,
// Kornilova 2023; statistics as in evo).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evolin_ros/geometry/pose.h"
#include "evolin_ros/metrics/protocol.h"

namespace evolin {

/// Maps points of the first camera to the second, from two poses camera to world.
Pose relativeMotion(const Pose& first, const Pose& second);

struct PoseErrors {
  double rotation = 0;           ///< degrees, 0 to 180
  double translation_angle = 0;  ///< between the two translations, degrees, 0 to 180
  double translation = 0;        ///< metres
};

/// Rotation: the angle of R_truth R_estimate^T. Translation: the length of the translation of
/// T_truth T_estimate^-1 under kEvolin, of T_truth^-1 T_estimate (the usual relative pose error)
/// under kPaper. The translation angle is 0 when neither motion translates and 90 when only one
/// does, there being no angle. Empty when the estimate is not finite.
std::optional<PoseErrors> poseErrors(const Pose& truth, const Pose& estimate, Protocol protocol);

/// The mean of each error, as of the two directions of a pair; empty when either is.
std::optional<PoseErrors> meanErrors(const std::optional<PoseErrors>& first,
                                     const std::optional<PoseErrors>& second);

/// What is known of one pair of frames.
struct PosePair {
  std::optional<PoseErrors> errors;  ///< empty: no pose was found
  double moved = 0;                  ///< translation of the true motion, metres
  bool ill_conditioned = false;      ///< found, but hanging on very few lines
};

struct PoseErrorOptions {
  double near_static = 0.01;          ///< pairs that moved less count as nearly static, metres
  double success_rotation = 1;        ///< largest rotation error of a success, degrees
  double success_translation = 0.05;  ///< largest translation error of a success, metres
};

/// Throws ConfigError for a value that is negative or not finite.
void validate(const PoseErrorOptions& options);

/// Seven figures of one error over the pairs that were found; all NaN when there is none. `std` is
/// that of the population.
struct ErrorStatistics {
  double rmse = 0;
  double mean = 0;
  double median = 0;
  double std = 0;
  double min = 0;
  double max = 0;
  double sse = 0;
};

/// Which of a pair's errors decides in a cumulative curve.
enum class AngleRule {
  kSmaller,  ///< the smaller of rotation and translation angle, as published
  kLarger,   ///< the larger of them, as elsewhere
};

class ResampledPoseErrors;

/// An accumulator over pairs of frames: add in any order, read at any time, merge, reset. Figures
/// do not depend on the order, to the last bit. 40 bytes a pair.
class PoseErrorMetrics {
 public:
  /// Throws as validate().
  explicit PoseErrorMetrics(const PoseErrorOptions& options = {});

  void addPair(const PosePair& pair);

  /// Pairs of `other` join these. Throws Error when the options differ.
  void merge(const PoseErrorMetrics& other);
  void reset();

  std::size_t pairs() const { return pairs_.size(); }
  std::size_t failed() const;
  std::size_t illConditioned() const;

  /// Pairs whose translation angle means little; failed ones among them.
  std::size_t nearStatic() const;

  /// Of each error over all pairs, a failed one infinite (the mean of the two in the middle of an
  /// even number); NaN without pairs.
  PoseErrors medians() const;

  /// The same with pair p, in order of addition, occurring weights[p] times.
  PoseErrors medians(const std::vector<std::uint32_t>& weights) const;

  /// For medians with many weights.
  ResampledPoseErrors resampled() const;

  ErrorStatistics rotationStatistics() const;
  ErrorStatistics translationAngleStatistics() const;
  ErrorStatistics translationStatistics() const;

  /// Share of all pairs with a rotation and a translation error within the options' limits; NaN
  /// without pairs.
  double successRate() const;

  /// Area under the share of pairs with an error of at most x, for x from 0 to `threshold`
  /// (degrees, above 0; otherwise Error), divided by `threshold`: trapezoids over the errors found,
  /// flat from the last one to the threshold. A failed pair is beyond every threshold. NaN without
  /// pairs.
  double areaUnderCurve(double threshold, AngleRule rule) const;

 private:
  ErrorStatistics statistics(double PoseErrors::*error) const;

  PoseErrorOptions options_;
  std::vector<PosePair> pairs_;
};

}  // namespace evolin
