// The evaluator's metric topics: a frame's or pair's own figures as they come, sums at a period.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "evolin_ros/evaluation/stream_evaluator.h"

namespace evolin::ros_shell {

/// Advertises what the options' families need; publishing is safe from several threads.
class MetricPublishers {
 public:
  MetricPublishers(ros::NodeHandle& handle, const PassOptions& options);

  /// Figures of single frames and pairs. `header` lends its frame_id.
  void publish(const EvaluationUpdate& update, const std_msgs::Header& header) const;

  /// Sums over a pass; `header` is that of the last input.
  void publishSums(const PassSums& pass, const std_msgs::Header& header) const;

 private:
  bool wants(MetricFamily family) const { return options_.families.count(family) != 0; }

  PassOptions options_;
  std::vector<RepeatabilitySetting> repeatability_settings_;
  std::vector<RepeatabilitySetting> repeatability_settings_by_score_;
  ros::Publisher detection_frame_;
  ros::Publisher detection_cumulative_;
  ros::Publisher heatmap_frame_;
  ros::Publisher heatmap_cumulative_;
  ros::Publisher repeatability_frame_;
  ros::Publisher repeatability_cumulative_;
  ros::Publisher association_frame_;
  ros::Publisher association_cumulative_;
  ros::Publisher detected_association_frame_;
  ros::Publisher detected_association_cumulative_;
  ros::Publisher pose_frame_;
  ros::Publisher pose_cumulative_;
  ros::Publisher tracks_cumulative_;
  ros::Publisher coverage_;
};

}  // namespace evolin::ros_shell
