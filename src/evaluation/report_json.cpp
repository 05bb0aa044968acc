// The report as strict JSON: no NaN, no infinity; null has a reason beside it.
#include <cmath>
#include <nlohmann/json.hpp>

#include "evolin_ros/base/version.h"
#include "evolin_ros/evaluation/report.h"
#include "report_families.h"

namespace evolin {

namespace {

using Json = nlohmann::ordered_json;

Json countsJson(const Classification& counts) {
  return {{"true_positives", counts.true_positives},
          {"predicted", counts.predicted},
          {"ground_truth", counts.ground_truth}};
}

void addRatios(Json* object, const Classification& counts) {
  (*object)["precision"] = counts.precision();
  (*object)["recall"] = counts.recall();
  (*object)["f_score"] = counts.fScore();
}

Json coverageJson(const Report& report) {
  const CoverageCounts& coverage = report.coverage;
  Json object = {{"input_images", nullptr},
                 {"seen", coverage.seen},
                 {"evaluated", coverage.evaluated},
                 {"waiting", coverage.waiting},
                 {"unmatched", coverage.unmatched},
                 {"dropped", coverage.dropped},
                 {"no_ground_truth", coverage.no_ground_truth},
                 {"bad_ground_truth", coverage.bad_ground_truth},
                 {"skipped", coverage.skipped},
                 {"no_depth", coverage.no_depth},
                 {"no_pose", coverage.no_pose},
                 {"waiting_depth", coverage.waiting_depth},
                 {"waiting_pose", coverage.waiting_pose},
                 {"bad_lines", coverage.bad_lines},
                 {"heatmap_skipped", coverage.heatmap_skipped},
                 {"pose_skipped", coverage.pose_skipped},
                 {"depth_left_out", coverage.depth_left_out},
                 {"poses_left_out", coverage.poses_left_out}};
  if (report.input_images) {
    object["input_images"] = *report.input_images;
  } else {
    object["reason"] = "nobody counted the images of the input";
  }
  return object;
}

Json detectionJson(const Report& report) {
  Json entries = Json::array();
  for (const DetectionEntry& entry : report.detection) {
    Json row = {{"distance", toString(entry.setting.distance)},
                {"threshold", entry.setting.threshold}};
    if (report.detection_frames > 0) {
      addRatios(&row, entry.counts);
    } else {
      row["precision"] = row["recall"] = row["f_score"] = nullptr;
    }
    if (entry.average_precision) {
      row["average_precision"] = *entry.average_precision;
    } else {
      row["average_precision"] = nullptr;
      row["reason"] = whyNoAveragePrecision(report, entry);
    }
    row["counts"] = countsJson(entry.counts);
    entries.push_back(std::move(row));
  }
  Json object = {{"source", report.lines_source},
                 {"ground_truth", report.ground_truth_source},
                 {"frames", report.detection_frames},
                 {"scored", report.scored},
                 {"spatial_spread", nullptr}};
  if (report.detection_frames > 0) {
    object["spatial_spread"] = report.spatial_spread;
  } else {
    object["reason"] = "no frame was evaluated";
  }
  object["entries"] = std::move(entries);
  return object;
}

Json associationJson(const Report& report) {
  Json object = {{"source", report.matches_source},
                 {"lines_source", report.matches_lines_source},
                 {"pairs", report.pairs.evaluated}};
  object["pairs_expected"] = report.pairs_expected ? Json(*report.pairs_expected) : Json(nullptr);
  if (report.pairs.evaluated > 0) {
    addRatios(&object, report.association);
  } else {
    object["precision"] = object["recall"] = object["f_score"] = nullptr;
    object["reason"] = whyNoAssociation(report);
  }
  if (!report.pairs_expected && report.pairs.evaluated > 0) {
    object["reason"] = "the newest matches are between detected lines: no number is expected";
  }
  object["counts"] = countsJson(report.association);
  object["not_evaluated"] = {{"detected_lines", report.pairs.detected_lines},
                             {"no_ground_truth", report.pairs.no_ground_truth},
                             {"bad_ground_truth", report.pairs.bad_ground_truth},
                             {"without_ids", report.pairs.without_ids},
                             {"skipped", report.pairs.skipped}};
  return object;
}

Json timingJson(const TimingSummary& timing) {
  if (timing.frames == 0) {
    return {{"frames", 0},
            {"latency_ms", nullptr},
            {"rate_hz", nullptr},
            {"reason", "no message carried a processing time"}};
  }
  constexpr double kMilliseconds = 1000;
  return {{"frames", timing.frames},
          {"latency_ms",
           {{"mean", timing.mean * kMilliseconds},
            {"median", timing.median * kMilliseconds},
            {"p95", timing.p95 * kMilliseconds},
            {"max", timing.max * kMilliseconds}}},
          {"rate_hz", timing.rate}};
}

Json stagesJson(const RunTiming& run) {
  Json object = {{"threads", run.threads},
                 {"frames", run.frames},
                 {"wall_s", run.wall},
                 {"recorded_s", run.recorded}};
  Json& seconds = object["seconds"] = Json::object();
  Json& processor = object["processor_seconds"] = Json::object();
  for (int i = 0; i < static_cast<int>(Stage::kCount); ++i) {
    const auto stage = static_cast<Stage>(i);
    seconds[toString(stage)] = run.stages.of(stage).wall;
    processor[toString(stage)] = run.stages.of(stage).processor;
  }
  return object;
}

Json intervalJson(const FigureInterval& figure) {
  Json object = {{"family", figure.family}, {"figure", figure.figure}};
  if (figure.step) {
    object["step"] = *figure.step;
  }
  if (figure.distance) {
    object["distance"] = toString(*figure.distance);
  }
  if (figure.threshold) {
    object["threshold"] = *figure.threshold;
  }
  if (figure.score_threshold) {
    object["score_threshold"] = *figure.score_threshold;
  }
  const ConfidenceInterval& interval = figure.interval;
  object["low"] = std::isfinite(interval.low) ? Json(interval.low) : Json(nullptr);
  object["high"] = std::isfinite(interval.high) ? Json(interval.high) : Json(nullptr);
  if (std::isnan(interval.low) || std::isnan(interval.high)) {
    object["reason"] = "the figure is undefined, or has no bounded values, in the resamples";
  } else if (std::isinf(interval.low) || std::isinf(interval.high)) {
    object["reason"] = "infinite: half of the pairs of a resample have no estimate";
  }
  return object;
}

Json confidenceJson(const Report& report) {
  if (!report.confidence) {
    return {{"intervals", nullptr}, {"reason", "no intervals were asked for with this report"}};
  }
  const BootstrapOptions& options = report.confidence->options;
  Json intervals = Json::array();
  for (const FigureInterval& figure : report.confidence->figures) {
    intervals.push_back(intervalJson(figure));
  }
  return {{"level", options.level},
          {"resamples", options.resamples},
          {"block_length", options.block_length},
          {"seed", options.seed},
          {"intervals", std::move(intervals)}};
}

}  // namespace

std::string toJson(const Report& report) {
  Json root = {{"program", programVersion()},
               {"protocol", toString(report.protocol)},
               {"complete", report.complete},
               {"pass", report.pass},
               {"coverage", coverageJson(report)}};
  const auto wants = [&report](MetricFamily family) { return report.families.count(family) != 0; };
  if (wants(MetricFamily::kDetection)) {
    root["detection"] = detectionJson(report);
  }
  if (wants(MetricFamily::kHeatmap)) {
    root["heatmap"] = heatmapJson(report);
  }
  if (wants(MetricFamily::kRepeatability)) {
    root["repeatability"] = repeatabilityJson(report);
  }
  if (wants(MetricFamily::kAssociation)) {
    root["association"] = associationJson(report);
    root["association_detected"] = detectedAssociationJson(report);
  }
  if (wants(MetricFamily::kPose)) {
    root["pose"] = poseJson(report);
  }
  if (wants(MetricFamily::kTracks)) {
    root["tracks"] = tracksJson(report);
  }
  root["confidence"] = confidenceJson(report);
  root["timing"] = {{"detector", timingJson(report.detector_timing)},
                    {"associator", timingJson(report.associator_timing)}};
  if (report.run) {
    root["timing"]["run"] = stagesJson(*report.run);
  }
  root["notes"] = report.notes;
  Json provenance = Json::object();
  for (const auto& [key, text] : report.provenance) {
    // Texts come from outside; what is no JSON is kept as a string rather than lost.
    Json value = Json::parse(text, nullptr, false);
    provenance[key] = value.is_discarded() ? Json(text) : std::move(value);
  }
  root["provenance"] = std::move(provenance);
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace evolin
