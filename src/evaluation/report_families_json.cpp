// Heatmap, repeatability, association of detected lines, relative pose and tracks as strict JSON.
#include <cmath>

#include "report_families.h"

namespace evolin {

namespace {

using Json = nlohmann::ordered_json;

/// null for what is no number.
Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json optionalOrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

void addReason(Json* object, const std::string& reason) {
  if (!reason.empty()) {
    (*object)["reason"] = reason;
  }
}

Json statisticsJson(const ErrorStatistics& statistics) {
  Json object = {
      {"rmse", numberOrNull(statistics.rmse)},     {"mean", numberOrNull(statistics.mean)},
      {"median", numberOrNull(statistics.median)}, {"std", numberOrNull(statistics.std)},
      {"min", numberOrNull(statistics.min)},       {"max", numberOrNull(statistics.max)},
      {"sse", numberOrNull(statistics.sse)}};
  if (!std::isfinite(statistics.sse)) {
    object["reason"] = "the errors are beyond the range of numbers";
  }
  return object;
}

Json statisticsJson(const PoseErrorMetrics& errors) {
  if (errors.pairs() == errors.failed()) {
    return {{"rotation", nullptr},
            {"translation_angle", nullptr},
            {"translation", nullptr},
            {"reason", "no pose was found"}};
  }
  return {{"rotation", statisticsJson(errors.rotationStatistics())},
          {"translation_angle", statisticsJson(errors.translationAngleStatistics())},
          {"translation", statisticsJson(errors.translationStatistics())}};
}

void addMedians(const PoseErrorMetrics& errors, Json* object) {
  const PoseErrors medians = errors.medians();
  (*object)["rotation_median_deg"] = numberOrNull(medians.rotation);
  (*object)["translation_angle_median_deg"] = numberOrNull(medians.translation_angle);
  (*object)["translation_median_m"] = numberOrNull(medians.translation);
  if (!std::isfinite(medians.rotation)) {
    (*object)["reason"] =
        "no pose was found for half of the pairs or more: the medians are infinite";
  }
  (*object)["success_rate"] = errors.successRate();
}

}  // namespace

Json heatmapJson(const Report& report) {
  const HeatmapReport& heatmap = report.heatmap;
  Json object = {{"frames", heatmap.frames},
                 {"pending", heatmap.pending},
                 {"skipped", report.coverage.heatmap_skipped}};
  const std::string reason = whyNoHeatmap(report);
  Json entries = Json::array();
  for (std::size_t i = 0; i < heatmap.counts.size(); ++i) {
    const Classification& counts = heatmap.counts[i];
    Json entry = Json::object();
    if (!heatmap.score_thresholds.empty()) {
      entry["score_threshold"] = heatmap.score_thresholds[i];
    }
    if (reason.empty()) {
      entry["precision"] = counts.precision();
      entry["recall"] = counts.recall();
      entry["f_score"] = counts.fScore();
    } else {
      entry["precision"] = entry["recall"] = entry["f_score"] = nullptr;
      entry["reason"] = reason;
    }
    entry["counts"] = {{"true_positives", counts.true_positives},
                       {"predicted", counts.predicted},
                       {"ground_truth", counts.ground_truth}};
    entries.push_back(std::move(entry));
  }
  if (heatmap.unscored.frames > 0) {
    const Classification& counts = heatmap.unscored.counts;
    object["unscored"] = {{"frames", heatmap.unscored.frames + heatmap.unscored.empty_frames},
                          {"precision", counts.precision()},
                          {"recall", counts.recall()},
                          {"f_score", counts.fScore()},
                          {"counts",
                           {{"true_positives", counts.true_positives},
                            {"predicted", counts.predicted},
                            {"ground_truth", counts.ground_truth}}}};
  }
  if (!heatmap.score_thresholds.empty()) {
    const HeatmapSummary summary = summarizeHeatmap(heatmap.counts);
    object["average_precision"] = reason.empty() ? Json(summary.average_precision) : Json(nullptr);
    object["max_f_score"] = reason.empty() ? Json(summary.max_f_score) : Json(nullptr);
    addReason(&object, reason);
  }
  object["entries"] = std::move(entries);
  return object;
}

Json repeatabilityJson(const Report& report) {
  const RepeatabilityReport& repeatability = report.repeatability;
  Json entries = Json::array();
  for (const RepeatabilityRow& row : repeatability.rows) {
    Json entry = {{"step", row.setting.frame_step},
                  {"distance", toString(row.setting.distance)},
                  {"threshold", row.setting.distance_threshold},
                  {"pairs", row.pairs},
                  {"repeatability", nullptr},
                  {"localization_error", nullptr}};
    if (row.setting.score_threshold) {
      entry["score_threshold"] = *row.setting.score_threshold;
    }
    if (row.figures) {
      entry["repeatability"] = row.figures->repeatability;
      entry["localization_error"] = row.figures->localization_error;
    }
    addReason(&entry, whyNoRepeatability(report, row));
    entries.push_back(std::move(entry));
  }
  const std::string reason =
      repeatability.rows.empty() ? "" : whyNoRepeatability(report, repeatability.rows.front());
  const OneToOneRepeatability& one_to_one = repeatability.one_to_one;
  Json one = {{"pairs", one_to_one.pairs()}, {"by_count", nullptr}, {"by_length", nullptr}};
  if (one_to_one.visible() > 0) {
    one["by_count"] = one_to_one.byCount();
    one["by_length"] = one_to_one.byLength();
  } else {
    one["reason"] = reason.empty() ? "no line of one frame is visible in the other" : reason;
  }
  const BestLocalization& best = repeatability.best_localization;
  Json localization = {{"count", repeatability.best_count},
                       {"pairs", best.pairs()},
                       {"short_pairs", best.shortPairs()},
                       {"error", optionalOrNull(best.error())}};
  if (!best.error()) {
    localization["reason"] = reason.empty() ? "no line was found again" : reason;
  }
  return {{"frames", repeatability.counts.frames},
          {"no_depth", repeatability.counts.no_depth},
          {"no_pose", repeatability.counts.no_pose},
          {"bad_lines", repeatability.counts.bad_lines},
          {"late", repeatability.counts.late},
          {"unscored_pairs", repeatability.counts.unscored_pairs},
          {"entries", std::move(entries)},
          {"one_to_one", std::move(one)},
          {"best_localization", std::move(localization)}};
}

Json detectedAssociationJson(const Report& report) {
  const DetectedAssociation& counts = report.detected_association;
  const DetectedPairCounts& pairs = report.detected_pairs;
  Json object = {{"pairs", pairs.evaluated}};
  const std::string reason = whyNoDetectedAssociation(report);
  if (reason.empty()) {
    object["precision"] = counts.precision();
    object["recall"] = counts.recall();
    object["f_score"] = counts.fScore();
  } else {
    object["precision"] = object["recall"] = object["f_score"] = nullptr;
    object["reason"] = reason;
  }
  object["counts"] = {{"true_pairs", counts.true_pairs},
                      {"predicted_pairs", counts.predicted_pairs},
                      {"pairs_without_truth", counts.pairs_without_truth},
                      {"joined_lines", counts.joined_lines},
                      {"visible_lines", counts.visible_lines}};
  object["not_evaluated"] = {{"no_ground_truth", pairs.no_ground_truth},
                             {"without_ids", pairs.without_ids},
                             {"skipped", pairs.skipped}};
  return object;
}

Json poseJson(const Report& report) {
  const PoseReport& pose = report.pose;
  const PoseErrorMetrics& errors = pose.errors;
  const MotionCounts& counts = report.repeatability.counts;
  Json object = {{"strategy", toString(pose.method.strategy)},
                 {"step", pose.frame_step > 0 ? Json(pose.frame_step) : Json(nullptr)},
                 {"pairs", errors.pairs()},
                 {"failed", errors.failed()},
                 {"ill_conditioned", errors.illConditioned()},
                 {"moved_less_than_1_cm", errors.nearStatic()},
                 {"pending", pose.pending}};
  const std::string reason = whyNoPose(report);
  if (reason.empty()) {
    addMedians(errors, &object);
    Json areas = Json::array();
    for (const double threshold : pose.auc_thresholds) {
      areas.push_back({{"threshold_deg", threshold},
                       {"auc", errors.areaUnderCurve(threshold, AngleRule::kSmaller)},
                       {"auc_max", errors.areaUnderCurve(threshold, AngleRule::kLarger)}});
    }
    object["auc"] = std::move(areas);
    object["statistics"] = statisticsJson(errors);
  } else {
    for (const char* name : {"rotation_median_deg", "translation_angle_median_deg",
                             "translation_median_m", "success_rate", "auc", "statistics"}) {
      object[name] = nullptr;
    }
    object["reason"] = reason;
  }
  object["not_evaluated"] = {{"no_depth", counts.pairs_no_depth},
                             {"no_pose", counts.pairs_no_pose},
                             {"no_lines", counts.pairs_no_lines},
                             {"bad_lines", counts.pairs_bad_lines},
                             {"left_buffer", counts.pairs_left_buffer},
                             {"skipped", counts.pairs_skipped + report.coverage.pose_skipped}};
  return object;
}

Json tracksJson(const Report& report) {
  const TrackReport& tracks = report.tracks;
  Json object = {{"frames", tracks.frames},
                 {"late", tracks.late},
                 {"from", tracks.from_matches ? "matches" : "ids"},
                 {"tracks", tracks.tracks},
                 {"mean_length", optionalOrNull(tracks.mean_length)},
                 {"median_length", optionalOrNull(tracks.median_length)},
                 {"longest", tracks.longest},
                 {"observations", tracks.observations},
                 {"identity_switches", tracks.identity_switches},
                 {"drifts", tracks.drifts}};
  if (!tracks.mean_length) {
    object["reason"] = tracks.reason.empty() ? "no line was followed" : tracks.reason;
  }
  if (!tracks.reason.empty()) {
    for (const char* name :
         {"from", "tracks", "longest", "observations", "identity_switches", "drifts"}) {
      object[name] = nullptr;
    }
  }
  return object;
}

}  // namespace evolin
