// Heatmap, repeatability, association of detected lines, relative pose and tracks as Markdown and
// tables.
#include <iomanip>
#include <locale>
#include <sstream>

#include "evolin_ros/base/text.h"
#include "report_families.h"

namespace evolin {

namespace {

std::string ratios(double precision, double recall, double f_score) {
  return percentText(precision) + " | " + percentText(recall) + " | " + percentText(f_score);
}

std::string optionalText(const std::optional<double>& value) {
  return value ? fixedText(*value, 1) : "-";
}

void appendPose(const Pose& pose, std::string* text) {
  for (const double value :
       {pose.translation.x(), pose.translation.y(), pose.translation.z(), pose.rotation.x(),
        pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}) {
    *text += " " + formatDouble(value + 0.0);  // no -0
  }
}

}  // namespace

std::string fixedText(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string percentText(double ratio) { return fixedText(100 * ratio, 1); }

std::string heatmapSection(const Report& report) {
  const HeatmapReport& heatmap = report.heatmap;
  std::string text = "\n## Detection on pixels (heatmap)\n\n";
  const std::string reason = whyNoHeatmap(report);
  const UnscoredHeatmap& unscored = heatmap.unscored;
  if (!reason.empty() && unscored.frames == 0) {
    return text + reason + "\n";
  }
  text +=
      "| score above | precision | recall | F | frames |\n| --- | ---: | ---: | ---: | ---: |\n";
  if (unscored.frames > 0) {
    text +=
        "| (lines without scores) | " +
        ratios(unscored.counts.precision(), unscored.counts.recall(), unscored.counts.fScore()) +
        " | " + std::to_string(unscored.frames + unscored.empty_frames) + " |\n";
  }
  if (!reason.empty()) {
    return text + "\n" + reason + "\n";
  }
  for (std::size_t i = 0; i < heatmap.counts.size(); ++i) {
    const Classification& counts = heatmap.counts[i];
    text += "| " +
            (heatmap.score_thresholds.empty() ? "(all lines)"
                                              : formatDouble(heatmap.score_thresholds[i])) +
            " | " + ratios(counts.precision(), counts.recall(), counts.fScore()) + " | " +
            std::to_string(heatmap.frames) + " |\n";
  }
  if (!heatmap.score_thresholds.empty()) {
    const HeatmapSummary summary = summarizeHeatmap(heatmap.counts);
    text += "\nAverage precision " + percentText(summary.average_precision) + ", largest F " +
            percentText(summary.max_f_score) + ".\n";
  }
  return text;
}

std::string repeatabilitySection(const Report& report) {
  const RepeatabilityReport& repeatability = report.repeatability;
  std::string text = "\n## Repeatability\n\n";
  bool any = false;
  for (const RepeatabilityRow& row : repeatability.rows) {
    any = any || row.figures.has_value();
  }
  if (!any) {
    return text +
           (repeatability.rows.empty() ? ""
                                       : whyNoRepeatability(report, repeatability.rows.front())) +
           "\n";
  }
  text +=
      "| step | distance | repeatability | localisation error | pairs |\n"
      "| ---: | --- | ---: | ---: | ---: |\n";
  for (const RepeatabilityRow& row : repeatability.rows) {
    text +=
        "| " + std::to_string(row.setting.frame_step) + " | " + toString(row.setting.distance) +
        " " + formatDouble(row.setting.distance_threshold) +
        (row.setting.score_threshold ? ", score above " + formatDouble(*row.setting.score_threshold)
                                     : "") +
        " | " +
        (row.figures ? percentText(row.figures->repeatability) + " | " +
                           fixedText(row.figures->localization_error, 2)
                     : whyNoRepeatability(report, row) + " | -") +
        " | " + std::to_string(row.pairs) + " |\n";
  }
  const OneToOneRepeatability& one_to_one = repeatability.one_to_one;
  if (one_to_one.visible() > 0) {
    text += "\nOne to one " + percentText(one_to_one.byCount()) + " by count, " +
            percentText(one_to_one.byLength()) + " by length.";
    const std::optional<double> error = repeatability.best_localization.error();
    if (error) {
      text += " Localisation error of the " + std::to_string(repeatability.best_count) + " best " +
              fixedText(*error, 2) + ".";
    }
    text += "\n";
  }
  return text;
}

std::string detectedAssociationSection(const Report& report) {
  if (report.pairs.detected_lines == 0) {
    return {};
  }
  std::string text = "\n## Association of detected lines\n\n";
  const std::string reason = whyNoDetectedAssociation(report);
  if (!reason.empty()) {
    return text + reason + "\n";
  }
  const DetectedAssociation& counts = report.detected_association;
  return text + "| precision | recall | F | pairs |\n| ---: | ---: | ---: | ---: |\n| " +
         ratios(counts.precision(), counts.recall(), counts.fScore()) + " | " +
         std::to_string(report.detected_pairs.evaluated) + " |\n";
}

std::string poseSection(const Report& report) {
  const PoseErrorMetrics& errors = report.pose.errors;
  std::string text =
      "\n## Relative pose (strategy `" + toString(report.pose.method.strategy) + "`" +
      (report.pose.frame_step > 0 ? ", step " + std::to_string(report.pose.frame_step) : "") +
      ")\n\n";
  const std::string reason = whyNoPose(report);
  if (!reason.empty()) {
    return text + reason + "\n";
  }
  const PoseErrors medians = errors.medians();
  text +=
      "| median rotation, deg | median translation, m | median translation angle, deg | success | "
      "pairs | failed |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n| ";
  text += fixedText(medians.rotation, 4) + " | " + fixedText(medians.translation, 5) + " | " +
          fixedText(medians.translation_angle, 2) + " | " + percentText(errors.successRate()) +
          " | " + std::to_string(errors.pairs()) + " | " + std::to_string(errors.failed()) + " |\n";
  text += "\n| angle up to, deg | AUC | AUC of the larger angle |\n| ---: | ---: | ---: |\n";
  for (const double threshold : report.pose.auc_thresholds) {
    text += "| " + formatDouble(threshold) + " | " +
            percentText(errors.areaUnderCurve(threshold, AngleRule::kSmaller)) + " | " +
            percentText(errors.areaUnderCurve(threshold, AngleRule::kLarger)) + " |\n";
  }
  if (errors.illConditioned() + errors.nearStatic() > 0) {
    text += "\n" + std::to_string(errors.illConditioned()) + " pairs are ill-conditioned; " +
            std::to_string(errors.nearStatic()) +
            " moved less than 1 cm (their translation angle means little).\n";
  }
  return text;
}

std::string tracksSection(const Report& report) {
  const TrackReport& tracks = report.tracks;
  std::string text = "\n## Tracks\n\n";
  if (!tracks.mean_length) {
    return text + (tracks.reason.empty() ? "no line was followed" : tracks.reason) + "\n";
  }
  return text +
         "| tracks | mean length | median length | longest | identity switches | drifts |\n"
         "| ---: | ---: | ---: | ---: | ---: | ---: |\n| " +
         std::to_string(tracks.tracks) + " | " + optionalText(tracks.mean_length) + " | " +
         optionalText(tracks.median_length) + " | " + std::to_string(tracks.longest) + " | " +
         std::to_string(tracks.identity_switches) + " | " + std::to_string(tracks.drifts) +
         " |\n\nLengths in frames, tracks by " +
         (tracks.from_matches ? "matches of neighbouring frames" : "the ids of the lines") + ".\n";
}

std::string repeatabilityToCsv(const Report& report) {
  std::string text =
      "first_stamp,stamp,step,distance,threshold,score_threshold,lines,found_forward,found_"
      "backward,repeatability,"
      "localization_error,one_to_one_by_count,one_to_one_by_length,best_localization_error\n";
  for (const RepeatabilityRecord& record : report.repeatability.records) {
    std::size_t of_all = 0;
    std::size_t by_score = 0;
    for (const RepeatabilityRow& row : report.repeatability.rows) {
      const std::optional<double>& score = row.setting.score_threshold;
      const std::vector<PairRepeatability>& pairs = score ? record.by_score : record.pair;
      std::size_t& index = score ? by_score : of_all;
      if (row.setting.frame_step != record.frame_step || index >= pairs.size()) {
        continue;
      }
      const PairRepeatability& pair = pairs[index++];
      text += formatStamp(record.first_stamp) + "," + formatStamp(record.stamp) + "," +
              std::to_string(record.frame_step) + "," + toString(row.setting.distance) + "," +
              formatDouble(row.setting.distance_threshold) + "," +
              (score ? formatDouble(*score) : "") + "," + std::to_string(pair.lines) + "," +
              std::to_string(pair.forward.count) + "," + std::to_string(pair.backward.count) + "," +
              formatDouble(pair.repeatability()) + "," +
              formatDouble(pair.localizationError(report.protocol)) + ",";
      // Those beyond the article are of the first step alone.
      const bool first_step =
          record.frame_step == report.repeatability.rows.front().setting.frame_step;
      text += first_step ? formatDouble(record.one_to_one_by_count) + "," +
                               formatDouble(record.one_to_one_by_length) + "," +
                               (record.best.used > 0 ? formatDouble(record.best.mean_distance) : "")
                         : ",,";
      text += "\n";
    }
  }
  return text;
}

std::string posesToCsv(const Report& report) {
  std::string text =
      "first_stamp,stamp,step,matches,with_depth,inliers,rotation_error_deg,translation_angle_deg,"
      "translation_error_m,moved_m,ill_conditioned,reason\n";
  for (const PoseRecord& record : report.pose.records) {
    text += formatStamp(record.first_stamp) + "," + formatStamp(record.stamp) + "," +
            std::to_string(record.frame_step) + "," + std::to_string(record.matched) + "," +
            std::to_string(record.with_depth) + "," + std::to_string(record.inliers) + ",";
    const std::optional<PoseErrors>& errors = record.pair.errors;
    text += errors
                ? formatDouble(errors->rotation) + "," + formatDouble(errors->translation_angle) +
                      "," + formatDouble(errors->translation)
                : ",,";
    // Reasons are our own sentences; a comma within one must not make a column.
    std::string reason = record.reason;
    for (char& letter : reason) {
      letter = letter == ',' || letter == '\n' ? ';' : letter;
    }
    text += "," + formatDouble(record.pair.moved) + "," +
            (record.pair.ill_conditioned ? "1" : "0") + "," + reason + "\n";
  }
  return text;
}

std::string motionsToTum(const Report& report, bool estimated) {
  std::string text =
      "# pose of the second camera of a pair in the first one's frame, at the second image's "
      "stamp\n# stamp tx ty tz qx qy qz qw\n";
  for (const PoseRecord& record : report.pose.records) {
    if (estimated && !record.estimate) {
      continue;
    }
    text += formatStamp(record.stamp);
    appendPose(inverse(estimated ? *record.estimate : record.truth), &text);
    text += "\n";
  }
  return text;
}

}  // namespace evolin
