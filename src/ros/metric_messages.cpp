// What is not defined is NaN in a message: a flat number that plots as a gap.
#include "metric_messages.h"

#include <cstdint>
#include <limits>

namespace evolin::ros_shell {

namespace {

constexpr double kNotDefined = std::numeric_limits<double>::quiet_NaN();

template <class Message>
Message begun(const MetricHead& head) {
  Message message;
  message.header = head.header;
  message.cumulative = static_cast<std::uint8_t>(head.cumulative);
  message.protocol = toString(head.protocol);
  return message;
}

template <class Message>
Message begunWithFrames(const MetricHead& head) {
  Message message = begun<Message>(head);
  message.frames = static_cast<std::uint32_t>(head.frames);
  return message;
}

evolin_ros::ClassificationEntry entryNamed(const std::string& name) {
  evolin_ros::ClassificationEntry entry;
  entry.name = name;
  entry.threshold = kNotDefined;
  entry.score_threshold = kNotDefined;
  entry.average_precision = kNotDefined;
  return entry;
}

template <class Counts>
evolin_ros::ClassificationEntry entryOf(const std::string& name, const Counts& counts) {
  evolin_ros::ClassificationEntry entry = entryNamed(name);
  entry.precision = counts.precision();
  entry.recall = counts.recall();
  entry.f_score = counts.fScore();
  return entry;
}

evolin_ros::RepeatabilityEntry entryOf(const RepeatabilitySetting& setting) {
  evolin_ros::RepeatabilityEntry entry;
  entry.step = static_cast<std::uint32_t>(setting.frame_step);
  entry.distance = toString(setting.distance);
  entry.threshold = setting.distance_threshold;
  entry.score_threshold = setting.score_threshold.value_or(kNotDefined);
  entry.repeatability = kNotDefined;
  entry.localization_error = kNotDefined;
  return entry;
}

void addEntries(const RepeatabilityMetrics& metrics, evolin_ros::RepeatabilityMetrics* message) {
  for (std::size_t i = 0; i < metrics.settings().size(); ++i) {
    evolin_ros::RepeatabilityEntry entry = entryOf(metrics.settings()[i]);
    if (const std::optional<RepeatabilityFigures> figures = metrics.figures(i)) {
      entry.repeatability = figures->repeatability;
      entry.localization_error = figures->localization_error;
    }
    message->entries.push_back(entry);
  }
}

void addEntries(const std::vector<RepeatabilitySetting>& settings, int frame_step,
                const std::vector<PairRepeatability>& pairs, Protocol protocol,
                evolin_ros::RepeatabilityMetrics* message) {
  auto pair = pairs.begin();
  for (const RepeatabilitySetting& setting : settings) {
    if (setting.frame_step != frame_step || pair == pairs.end()) {
      continue;
    }
    evolin_ros::RepeatabilityEntry entry = entryOf(setting);
    entry.repeatability = pair->repeatability();
    entry.localization_error = pair->localizationError(protocol);
    message->entries.push_back(entry);
    ++pair;
  }
}

}  // namespace

evolin_ros::DetectionMetrics detectionMessage(const MetricHead& head,
                                              const std::vector<DetectionEntry>& entries,
                                              double spatial_spread) {
  auto message = begunWithFrames<evolin_ros::DetectionMetrics>(head);
  message.spatial_spread = spatial_spread;
  for (const DetectionEntry& entry : entries) {
    evolin_ros::ClassificationEntry row = entryOf("vectorized", entry.counts);
    row.distance = toString(entry.setting.distance);
    row.threshold = entry.setting.threshold;
    row.average_precision = entry.average_precision.value_or(kNotDefined);
    message.entries.push_back(row);
  }
  return message;
}

evolin_ros::HeatmapMetrics heatmapMessage(const MetricHead& head,
                                          const std::vector<double>& score_thresholds,
                                          const std::vector<Classification>& counts) {
  auto message = begunWithFrames<evolin_ros::HeatmapMetrics>(head);
  message.average_precision = kNotDefined;
  message.max_f_score = kNotDefined;
  if (!score_thresholds.empty()) {
    const HeatmapSummary summary = summarizeHeatmap(counts);
    message.average_precision = summary.average_precision;
    message.max_f_score = summary.max_f_score;
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    message.entries.push_back(entryOf("heatmap", counts[i]));
    if (!score_thresholds.empty()) {
      message.entries.back().score_threshold = score_thresholds[i];
    }
  }
  return message;
}

evolin_ros::AssociationMetrics associationMessage(const MetricHead& head,
                                                  const Classification& counts) {
  auto message = begunWithFrames<evolin_ros::AssociationMetrics>(head);
  message.entries.push_back(entryOf("association", counts));
  return message;
}

evolin_ros::AssociationMetrics associationMessage(const MetricHead& head,
                                                  const DetectedAssociation& counts) {
  auto message = begunWithFrames<evolin_ros::AssociationMetrics>(head);
  message.entries.push_back(entryOf("association_detected", counts));
  return message;
}

evolin_ros::RepeatabilityMetrics repeatabilityMessage(
    const MetricHead& head, const RepeatabilityRecord& record,
    const std::vector<RepeatabilitySetting>& settings,
    const std::vector<RepeatabilitySetting>& settings_by_score, bool first_step) {
  auto message = begunWithFrames<evolin_ros::RepeatabilityMetrics>(head);
  message.one_to_one_by_count = first_step ? record.one_to_one_by_count : kNotDefined;
  message.one_to_one_by_length = first_step ? record.one_to_one_by_length : kNotDefined;
  message.best_localization_error =
      first_step && record.best.used > 0 ? record.best.mean_distance : kNotDefined;
  addEntries(settings, record.frame_step, record.pair, head.protocol, &message);
  addEntries(settings_by_score, record.frame_step, record.by_score, head.protocol, &message);
  return message;
}

evolin_ros::RepeatabilityMetrics repeatabilityMessage(const MetricHead& head,
                                                      const PassSums& sums) {
  auto message = begunWithFrames<evolin_ros::RepeatabilityMetrics>(head);
  const OneToOneRepeatability& one_to_one = sums.one_to_one;
  const bool visible = one_to_one.visible() > 0;
  message.one_to_one_by_count = visible ? one_to_one.byCount() : kNotDefined;
  message.one_to_one_by_length = visible ? one_to_one.byLength() : kNotDefined;
  message.best_localization_error = sums.best_localization.error().value_or(kNotDefined);
  addEntries(sums.repeatability, &message);
  if (sums.repeatability_by_score) {
    addEntries(*sums.repeatability_by_score, &message);
  }
  return message;
}

evolin_ros::PoseMetrics poseMessage(const MetricHead& head, const PoseErrorMetrics& errors,
                                    const std::string& strategy, int step,
                                    const std::vector<double>& auc_thresholds) {
  auto message = begun<evolin_ros::PoseMetrics>(head);
  message.strategy = strategy;
  message.step = static_cast<std::uint32_t>(step);
  message.pairs = static_cast<std::uint32_t>(errors.pairs());
  message.failed = static_cast<std::uint32_t>(errors.failed());
  message.ill_conditioned = static_cast<std::uint32_t>(errors.illConditioned());
  message.near_static = static_cast<std::uint32_t>(errors.nearStatic());
  const PoseErrors medians = errors.medians();
  message.rotation_median = medians.rotation;
  message.translation_median = medians.translation;
  message.translation_angle_median = medians.translation_angle;
  message.success_rate = errors.successRate();
  for (const double threshold : auc_thresholds) {
    evolin_ros::AucEntry entry;
    entry.threshold = threshold;
    entry.auc = errors.areaUnderCurve(threshold, AngleRule::kSmaller);
    entry.auc_max = errors.areaUnderCurve(threshold, AngleRule::kLarger);
    message.auc.push_back(entry);
  }
  return message;
}

evolin_ros::TrackMetrics trackMessage(const MetricHead& head, const TrackReport& tracks) {
  evolin_ros::TrackMetrics message;
  message.header = head.header;
  message.from = tracks.from_matches ? "matches" : "ids";
  message.frames = static_cast<std::uint32_t>(tracks.frames);
  message.tracks = tracks.tracks;
  message.mean_length = tracks.mean_length.value_or(kNotDefined);
  message.median_length = tracks.median_length.value_or(kNotDefined);
  message.longest = tracks.longest;
  message.observations = tracks.observations;
  message.identity_switches = tracks.identity_switches;
  message.drifts = tracks.drifts;
  return message;
}

evolin_ros::Coverage coverageMessage(const std_msgs::Header& header, const CoverageCounts& counts) {
  evolin_ros::Coverage message;
  message.header = header;
  message.seen = static_cast<std::uint32_t>(counts.seen);
  message.evaluated = static_cast<std::uint32_t>(counts.evaluated);
  message.unmatched = static_cast<std::uint32_t>(counts.unmatched);
  message.dropped = static_cast<std::uint32_t>(counts.dropped);
  message.no_ground_truth = static_cast<std::uint32_t>(counts.no_ground_truth);
  message.bad_ground_truth = static_cast<std::uint32_t>(counts.bad_ground_truth);
  message.skipped = static_cast<std::uint32_t>(counts.skipped);
  message.no_depth = static_cast<std::uint32_t>(counts.no_depth);
  message.no_pose = static_cast<std::uint32_t>(counts.no_pose);
  message.waiting_depth = static_cast<std::uint32_t>(counts.waiting_depth);
  message.waiting_pose = static_cast<std::uint32_t>(counts.waiting_pose);
  message.bad_lines = static_cast<std::uint32_t>(counts.bad_lines);
  message.heatmap_skipped = static_cast<std::uint32_t>(counts.heatmap_skipped);
  message.pose_skipped = static_cast<std::uint32_t>(counts.pose_skipped);
  message.depth_left_out = static_cast<std::uint32_t>(counts.depth_left_out);
  message.poses_left_out = static_cast<std::uint32_t>(counts.poses_left_out);
  return message;
}

}  // namespace evolin::ros_shell
