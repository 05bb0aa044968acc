// The evaluator's cumulative figures as text for the margin of a picture.
#pragma once

#include <evolin_ros/AssociationMetrics.h>
#include <evolin_ros/Coverage.h>
#include <evolin_ros/DetectionMetrics.h>
#include <evolin_ros/HeatmapMetrics.h>
#include <evolin_ros/PoseMetrics.h>
#include <evolin_ros/RepeatabilityMetrics.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "evolin_ros/drawing/evaluation_view.h"

namespace evolin::ros_shell {

/// Keeps the last message of each family. Ratios are in percent; what nobody has sent, or what is
/// not defined, is "-". Always the same rows, so that the picture keeps its size.
class ViewNumbers {
 public:
  /// Of the vectorized figures those of the structural distance at `threshold` are shown.
  explicit ViewNumbers(double threshold) : threshold_(threshold) {}

  /// True when the figures have begun anew: fewer frames than before.
  bool take(const evolin_ros::DetectionMetrics& message);
  void take(const evolin_ros::HeatmapMetrics& message) { heatmap_ = message; }
  void take(const evolin_ros::RepeatabilityMetrics& message) { repeatability_ = message; }
  /// Of matches between ground-truth lines, and between detected ones; shown are those of which
  /// there are more pairs of frames.
  void takeTrue(const evolin_ros::AssociationMetrics& message) { association_ = message; }
  void takeDetected(const evolin_ros::AssociationMetrics& message) { detected_ = message; }
  void take(const evolin_ros::PoseMetrics& message) { pose_ = message; }
  void take(const evolin_ros::Coverage& message) { coverage_ = message; }

  /// `unpaired` messages were part of no picture.
  std::vector<ViewSection> sections(std::size_t unpaired) const;

 private:
  ViewSection detection() const;
  ViewSection repeatability() const;
  ViewSection association() const;
  ViewSection pose() const;

  double threshold_;
  std::optional<evolin_ros::DetectionMetrics> detection_;
  std::optional<evolin_ros::HeatmapMetrics> heatmap_;
  std::optional<evolin_ros::RepeatabilityMetrics> repeatability_;
  std::optional<evolin_ros::AssociationMetrics> association_;
  std::optional<evolin_ros::AssociationMetrics> detected_;
  std::optional<evolin_ros::PoseMetrics> pose_;
  std::optional<evolin_ros::Coverage> coverage_;
};

}  // namespace evolin::ros_shell
