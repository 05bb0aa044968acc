// Errors of relative poses; every figure is computed from sorted values.
#include "evolin_ros/metrics/pose_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/metrics/resampled_pose_errors.h"

namespace evolin {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double degrees(double radians) { return radians * 180 / kPi; }

bool isFinite(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

/// Angle of a rotation; exact for small ones, where the arc cosine of the trace is not.
double rotationAngle(const Eigen::Quaterniond& rotation) {
  return 2 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const bool a_moves = a.norm() > 0;
  const bool b_moves = b.norm() > 0;
  if (!a_moves || !b_moves) {
    return a_moves == b_moves ? 0 : kPi / 2;
  }
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void require(const std::string& key, double value) {
  if (!(value >= 0 && std::isfinite(value))) {
    throw ConfigError("pose error", key,
                      formatDouble(value) + ", expected a finite number of at least 0");
  }
}

}  // namespace

Pose relativeMotion(const Pose& first, const Pose& second) {
  const Eigen::Quaterniond to_second = second.rotation.conjugate();
  Pose motion;
  motion.rotation = (to_second * first.rotation).normalized();
  motion.translation = to_second * (first.translation - second.translation);
  return motion;
}

std::optional<PoseErrors> poseErrors(const Pose& truth, const Pose& estimate, Protocol protocol) {
  if (!isFinite(estimate)) {
    return std::nullopt;
  }
  const Eigen::Quaterniond difference = truth.rotation * estimate.rotation.conjugate();
  PoseErrors errors;
  errors.rotation = degrees(rotationAngle(difference));
  errors.translation_angle = degrees(angleBetween(truth.translation, estimate.translation));
  // inv(truth) * estimate turns the plain difference, which leaves its length.
  errors.translation = protocol == Protocol::kEvolin
                           ? (truth.translation - difference * estimate.translation).norm()
                           : (truth.translation - estimate.translation).norm();
  return errors;
}

std::optional<PoseErrors> meanErrors(const std::optional<PoseErrors>& first,
                                     const std::optional<PoseErrors>& second) {
  if (!first || !second) {
    return std::nullopt;
  }
  PoseErrors mean;
  mean.rotation = (first->rotation + second->rotation) / 2;
  mean.translation_angle = (first->translation_angle + second->translation_angle) / 2;
  mean.translation = (first->translation + second->translation) / 2;
  return mean;
}

void validate(const PoseErrorOptions& options) {
  require("near_static", options.near_static);
  require("success_rotation", options.success_rotation);
  require("success_translation", options.success_translation);
}

PoseErrorMetrics::PoseErrorMetrics(const PoseErrorOptions& options) : options_(options) {
  validate(options_);
}

void PoseErrorMetrics::addPair(const PosePair& pair) { pairs_.push_back(pair); }

void PoseErrorMetrics::merge(const PoseErrorMetrics& other) {
  if (options_.near_static != other.options_.near_static ||
      options_.success_rotation != other.options_.success_rotation ||
      options_.success_translation != other.options_.success_translation) {
    throw Error("pose error: merging figures of different options, expected the same");
  }
  // By index, so that an accumulator may be merged with itself.
  const std::size_t count = other.pairs_.size();
  pairs_.reserve(pairs_.size() + count);
  for (std::size_t pair = 0; pair < count; ++pair) {
    pairs_.push_back(other.pairs_[pair]);
  }
}

void PoseErrorMetrics::reset() { pairs_.clear(); }

std::size_t PoseErrorMetrics::failed() const {
  return static_cast<std::size_t>(std::count_if(pairs_.begin(), pairs_.end(),
                                                [](const PosePair& pair) { return !pair.errors; }));
}

std::size_t PoseErrorMetrics::illConditioned() const {
  return static_cast<std::size_t>(std::count_if(
      pairs_.begin(), pairs_.end(), [](const PosePair& pair) { return pair.ill_conditioned; }));
}

std::size_t PoseErrorMetrics::nearStatic() const {
  return static_cast<std::size_t>(
      std::count_if(pairs_.begin(), pairs_.end(),
                    [this](const PosePair& pair) { return pair.moved < options_.near_static; }));
}

PoseErrors PoseErrorMetrics::medians() const {
  return medians(std::vector<std::uint32_t>(pairs_.size(), 1));
}

PoseErrors PoseErrorMetrics::medians(const std::vector<std::uint32_t>& weights) const {
  return resampled().medians(weights);
}

ResampledPoseErrors PoseErrorMetrics::resampled() const { return ResampledPoseErrors(pairs_); }

ErrorStatistics PoseErrorMetrics::rotationStatistics() const {
  return statistics(&PoseErrors::rotation);
}

ErrorStatistics PoseErrorMetrics::translationAngleStatistics() const {
  return statistics(&PoseErrors::translation_angle);
}

ErrorStatistics PoseErrorMetrics::translationStatistics() const {
  return statistics(&PoseErrors::translation);
}

ErrorStatistics PoseErrorMetrics::statistics(double PoseErrors::*error) const {
  std::vector<double> values;
  for (const PosePair& pair : pairs_) {
    if (pair.errors) {
      values.push_back((*pair.errors).*error);
    }
  }
  if (values.empty()) {
    return {kNan, kNan, kNan, kNan, kNan, kNan, kNan};
  }
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  ErrorStatistics result;
  double sum = 0;
  for (const double value : values) {
    sum += value;
    result.sse += value * value;
  }
  result.mean = sum / count;
  result.rmse = std::sqrt(result.sse / count);
  double deviations = 0;
  for (const double value : values) {
    deviations += (value - result.mean) * (value - result.mean);
  }
  result.std = std::sqrt(deviations / count);
  result.median = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  result.min = values.front();
  result.max = values.back();
  return result;
}

double PoseErrorMetrics::successRate() const {
  if (pairs_.empty()) {
    return kNan;
  }
  const auto successes = std::count_if(pairs_.begin(), pairs_.end(), [this](const PosePair& pair) {
    return pair.errors && pair.errors->rotation <= options_.success_rotation &&
           pair.errors->translation <= options_.success_translation;
  });
  return static_cast<double>(successes) / static_cast<double>(pairs_.size());
}

double PoseErrorMetrics::areaUnderCurve(double threshold, AngleRule rule) const {
  if (!(threshold > 0 && std::isfinite(threshold))) {
    throw Error("pose error: threshold " + formatDouble(threshold) +
                " of the cumulative curve, expected a number of degrees above 0");
  }
  if (pairs_.empty()) {
    return kNan;
  }
  std::vector<double> values;
  for (const PosePair& pair : pairs_) {
    if (pair.errors) {
      const auto [smaller, larger] =
          std::minmax(pair.errors->rotation, pair.errors->translation_angle);
      values.push_back(rule == AngleRule::kSmaller ? smaller : larger);
    }
  }
  std::sort(values.begin(), values.end());
  double area = 0;
  double last = 0;
  double share = 0;
  for (std::size_t i = 0; i < values.size() && values[i] < threshold; ++i) {
    const double next = static_cast<double>(i + 1) / static_cast<double>(pairs_.size());
    area += (values[i] - last) * (share + next) / 2;
    last = values[i];
    share = next;
  }
  area += (threshold - last) * share;
  return area / threshold;
}

}  // namespace evolin
