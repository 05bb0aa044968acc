// Figures of an evaluation as messages, as free functions.
#pragma once

#include <evolin_ros/AssociationMetrics.h>
#include <evolin_ros/Coverage.h>
#include <evolin_ros/DetectionMetrics.h>
#include <evolin_ros/HeatmapMetrics.h>
#include <evolin_ros/PoseMetrics.h>
#include <evolin_ros/RepeatabilityMetrics.h>
#include <evolin_ros/TrackMetrics.h>

#include <string>
#include <vector>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "evolin_ros/evaluation/report.h"

namespace evolin::ros_shell {

/// What all metric messages begin with.
struct MetricHead {
  std_msgs::Header header;
  bool cumulative = false;
  std::size_t frames = 1;  ///< frames, or pairs of frames, in the figures
  Protocol protocol = Protocol::kEvolin;
};

evolin_ros::DetectionMetrics detectionMessage(const MetricHead& head,
                                              const std::vector<DetectionEntry>& entries,
                                              double spatial_spread);

/// `counts` by falling score threshold; thresholds empty: one entry.
evolin_ros::HeatmapMetrics heatmapMessage(const MetricHead& head,
                                          const std::vector<double>& score_thresholds,
                                          const std::vector<Classification>& counts);

evolin_ros::AssociationMetrics associationMessage(const MetricHead& head,
                                                  const Classification& counts);
evolin_ros::AssociationMetrics associationMessage(const MetricHead& head,
                                                  const DetectedAssociation& counts);

/// Of one pair; `settings` are those of all steps, of all lines and by score threshold.
evolin_ros::RepeatabilityMetrics repeatabilityMessage(
    const MetricHead& head, const RepeatabilityRecord& record,
    const std::vector<RepeatabilitySetting>& settings,
    const std::vector<RepeatabilitySetting>& settings_by_score, bool first_step);
/// Of all pairs.
evolin_ros::RepeatabilityMetrics repeatabilityMessage(const MetricHead& head, const PassSums& sums);

/// Of all pairs, or of one when the errors hold one.
evolin_ros::PoseMetrics poseMessage(const MetricHead& head, const PoseErrorMetrics& errors,
                                    const std::string& strategy, int step,
                                    const std::vector<double>& auc_thresholds);

evolin_ros::TrackMetrics trackMessage(const MetricHead& head, const TrackReport& tracks);

evolin_ros::Coverage coverageMessage(const std_msgs::Header& header, const CoverageCounts& counts);

}  // namespace evolin::ros_shell
