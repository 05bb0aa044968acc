// Topics of families that were not asked for do not exist.
#include "metric_publishers.h"

#include "conversions.h"
#include "metric_messages.h"
#include "topics.h"

namespace evolin::ros_shell {

namespace {

template <class Message>
void advertise(ros::NodeHandle& handle, const char* frame, const char* cumulative,
               ros::Publisher* of_frames, ros::Publisher* of_sums) {
  *of_frames = handle.advertise<Message>(frame, kResultQueue);
  *of_sums = handle.advertise<Message>(cumulative, kResultQueue, true);
}

}  // namespace

MetricPublishers::MetricPublishers(ros::NodeHandle& handle, const PassOptions& options)
    : options_(options),
      repeatability_settings_(RepeatabilityMetrics(options.motion.repeatabilities).settings()) {
  if (const MotionEvaluation motion(options.motion); motion.repeatabilityByScore()) {
    repeatability_settings_by_score_ = motion.repeatabilityByScore()->settings();
  }
  if (wants(MetricFamily::kDetection)) {
    advertise<evolin_ros::DetectionMetrics>(handle, topics::kDetectionFrame,
                                            topics::kDetectionCumulative, &detection_frame_,
                                            &detection_cumulative_);
  }
  if (wants(MetricFamily::kHeatmap)) {
    advertise<evolin_ros::HeatmapMetrics>(handle, topics::kHeatmapFrame, topics::kHeatmapCumulative,
                                          &heatmap_frame_, &heatmap_cumulative_);
  }
  if (wants(MetricFamily::kRepeatability)) {
    advertise<evolin_ros::RepeatabilityMetrics>(handle, topics::kRepeatabilityFrame,
                                                topics::kRepeatabilityCumulative,
                                                &repeatability_frame_, &repeatability_cumulative_);
  }
  if (wants(MetricFamily::kAssociation)) {
    advertise<evolin_ros::AssociationMetrics>(handle, topics::kAssociationFrame,
                                              topics::kAssociationCumulative, &association_frame_,
                                              &association_cumulative_);
    advertise<evolin_ros::AssociationMetrics>(
        handle, topics::kDetectedAssociationFrame, topics::kDetectedAssociationCumulative,
        &detected_association_frame_, &detected_association_cumulative_);
  }
  if (wants(MetricFamily::kPose)) {
    advertise<evolin_ros::PoseMetrics>(handle, topics::kPoseFrame, topics::kPoseCumulative,
                                       &pose_frame_, &pose_cumulative_);
  }
  if (wants(MetricFamily::kTracks)) {
    tracks_cumulative_ =
        handle.advertise<evolin_ros::TrackMetrics>(topics::kTracksCumulative, kResultQueue, true);
  }
  coverage_ = handle.advertise<evolin_ros::Coverage>(topics::kCoverage, kResultQueue, true);
}

void MetricPublishers::publish(const EvaluationUpdate& update,
                               const std_msgs::Header& header) const {
  const auto head_of = [&](Stamp stamp) {
    MetricHead head{header, false, 1, options_.evaluation.vectorized.protocol};
    head.header.stamp = toRosTime(stamp);
    return head;
  };
  if (wants(MetricFamily::kDetection)) {
    for (const FrameRecord& frame : update.frames) {
      if (frame.state == FrameState::kEvaluated) {
        detection_frame_.publish(
            detectionMessage(head_of(frame.stamp), frame.entries, frame.spatial_spread));
      }
    }
  }
  for (const HeatmapRecord& frame : update.heatmaps) {
    const std::vector<double> thresholds =
        frame.scored == false ? std::vector<double>()
                              : HeatmapMetrics(options_.evaluation.heatmap).scoreThresholds();
    heatmap_frame_.publish(heatmapMessage(head_of(frame.stamp), thresholds, frame.counts));
  }
  for (const RepeatabilityRecord& pair : update.repeatability) {
    const bool first_step = pair.frame_step == options_.motion.repeatabilities.frame_steps.front();
    repeatability_frame_.publish(
        repeatabilityMessage(head_of(pair.stamp), pair, repeatability_settings_,
                             repeatability_settings_by_score_, first_step));
  }
  if (wants(MetricFamily::kAssociation)) {
    for (const PairRecord& pair : update.pairs) {
      association_frame_.publish(associationMessage(head_of(pair.stamp), pair.counts));
    }
    for (const DetectedPairRecord& pair : update.detected_pairs) {
      detected_association_frame_.publish(associationMessage(head_of(pair.stamp), pair.counts));
    }
  }
  for (const PoseRecord& pair : update.poses) {
    PoseErrorMetrics errors(options_.evaluation.pose_errors);
    errors.addPair(pair.pair);
    pose_frame_.publish(poseMessage(head_of(pair.stamp), errors,
                                    toString(options_.motion.pose_method.strategy), pair.frame_step,
                                    options_.auc_thresholds));
  }
}

void MetricPublishers::publishSums(const PassSums& pass, const std_msgs::Header& header) const {
  const SequenceEvaluator& sums = pass.evaluator;
  const auto head_for = [&](std::size_t frames) {
    return MetricHead{header, true, frames, options_.evaluation.vectorized.protocol};
  };
  if (wants(MetricFamily::kDetection)) {
    detection_cumulative_.publish(detectionMessage(head_for(sums.detection().frames()),
                                                   sums.detectionEntries(), sums.spread().share()));
  }
  if (wants(MetricFamily::kHeatmap)) {
    const UnscoredHeatmap& unscored = sums.unscoredHeatmap();
    if (unscored.frames > 0 && sums.heatmapFrames() == unscored.empty_frames) {
      heatmap_cumulative_.publish(
          heatmapMessage(head_for(unscored.frames + unscored.empty_frames), {}, {unscored.counts}));
    } else {
      heatmap_cumulative_.publish(
          heatmapMessage(head_for(sums.heatmapFrames()), sums.heatmapThresholds(), sums.heatmap()));
    }
  }
  if (wants(MetricFamily::kRepeatability)) {
    std::size_t pairs = 0;
    for (const int step : options_.motion.repeatabilities.frame_steps) {
      pairs += pass.repeatability.pairs(step);
    }
    repeatability_cumulative_.publish(repeatabilityMessage(head_for(pairs), pass));
  }
  if (wants(MetricFamily::kAssociation)) {
    association_cumulative_.publish(associationMessage(head_for(sums.association().pairs()),
                                                       sums.association().classification()));
    detected_association_cumulative_.publish(associationMessage(
        head_for(sums.detectedAssociation().pairs()), sums.detectedAssociation().classification()));
  }
  if (wants(MetricFamily::kPose)) {
    pose_cumulative_.publish(poseMessage(head_for(sums.pose().pairs()), sums.pose(),
                                         toString(options_.motion.pose_method.strategy),
                                         pass.pose_step, options_.auc_thresholds));
  }
  if (wants(MetricFamily::kTracks)) {
    tracks_cumulative_.publish(trackMessage(head_for(0), pass.tracks));
  }
  coverage_.publish(coverageMessage(header, pass.coverage));
}

}  // namespace evolin::ros_shell
