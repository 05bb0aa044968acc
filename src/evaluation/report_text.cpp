// The report as a Markdown summary and as CSV tables.
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/evaluation/report.h"
#include "report_families.h"

namespace evolin {

namespace {

std::string milliseconds(double seconds) { return fixedText(1000 * seconds, 2); }

std::string settingName(const VectorizedSetting& setting) {
  return toString(setting.distance) + " " + formatDouble(setting.threshold);
}

std::string csvName(const VectorizedSetting& setting) {
  return toString(setting.distance) + "_" + formatDouble(setting.threshold);
}

std::string ratios(const Classification& counts) {
  return percentText(counts.precision()) + " | " + percentText(counts.recall()) + " | " +
         percentText(counts.fScore());
}

std::string timingRow(const std::string& name, const TimingSummary& timing) {
  if (timing.frames == 0) {
    return "| " + name + " | - | - | - | 0 |\n";
  }
  return "| " + name + " | " + milliseconds(timing.median) + " | " + milliseconds(timing.p95) +
         " | " + fixedText(timing.rate, 1) + " | " + std::to_string(timing.frames) + " |\n";
}

std::string stagesTable(const RunTiming& run) {
  std::string text = "\n" + std::to_string(run.frames) + " images in " + fixedText(run.wall, 2) +
                     " s on " + std::to_string(run.threads) +
                     (run.threads == 1 ? " thread" : " threads");
  if (run.recorded > 0) {
    text += ", " + fixedText(run.recorded / run.wall, 1) + " times as fast as they were recorded";
    if (run.threads == 1) {
      text += " (without the detector's own time: " +
              fixedText(run.recorded / (run.wall - run.stages.of(Stage::kDetect).wall), 1) + ")";
    }
  }
  text +=
      "\n\n| stage | s | ms a frame | of these on a processor |\n| --- | ---: | ---: | ---: |\n";
  const auto a_frame = [&run](double seconds) {
    return milliseconds(seconds / static_cast<double>(run.frames));
  };
  StageTime others;
  const auto add_row = [&](const std::string& name, const StageTime& time) {
    text += "| " + name + " | " + fixedText(time.wall, 3) + " | " + a_frame(time.wall) + " | " +
            a_frame(time.processor) + " |\n";
  };
  for (int i = 0; i < static_cast<int>(Stage::kCount); ++i) {
    const auto stage = static_cast<Stage>(i);
    const StageTime& time = run.stages.of(stage);
    if (time.wall > 0) {
      add_row(toString(stage), time);
      others += stage == Stage::kDetect ? StageTime() : time;
    }
  }
  add_row("all but detect", others);
  return text;
}

std::string coverageLine(const Report& report) {
  const CoverageCounts& coverage = report.coverage;
  std::string text = std::to_string(coverage.evaluated) + " of " + std::to_string(coverage.seen) +
                     " frames evaluated";
  const std::pair<const char*, std::size_t> reasons[] = {
      {"still waiting", coverage.waiting},
      {"without detected lines (unmatched)", coverage.unmatched},
      {"dropped (full buffer, or a stamp that fits nowhere)", coverage.dropped},
      {"without ground truth", coverage.no_ground_truth},
      {"with bad ground truth", coverage.bad_ground_truth},
      {"skipped", coverage.skipped},
      {"without depth", coverage.no_depth},
      {"without a pose", coverage.no_pose},
      {"with lines that are not finite", coverage.bad_lines},
      {"left out of the heatmap", coverage.heatmap_skipped},
      {"pairs left out of relative pose", coverage.pose_skipped},
      {"depth images without a stamp", coverage.depth_left_out},
      {"poses without a stamp", coverage.poses_left_out}};
  for (const auto& [name, count] : reasons) {
    if (count > 0) {
      text += "; " + std::to_string(count) + " " + name;
    }
  }
  // Not coverage.seen: a message that was dropped for its stamp is no image of its own.
  if (report.input_images && *report.input_images > report.frames.size()) {
    text += "; " + std::to_string(*report.input_images - report.frames.size()) + " of the " +
            std::to_string(*report.input_images) + " images of the input were never heard of";
  }
  return text + ".";
}

std::string detectionSection(const Report& report) {
  std::string text = "\n## Detection\n\n";
  if (report.detection_frames == 0) {
    return text + "not evaluated: no frame had both lines and ground truth\n";
  }
  text +=
      "| distance | precision | recall | F | average precision |\n"
      "| --- | ---: | ---: | ---: | ---: |\n";
  for (const DetectionEntry& entry : report.detection) {
    text += "| " + settingName(entry.setting) + " | " + ratios(entry.counts) + " | " +
            (entry.average_precision ? percentText(*entry.average_precision)
                                     : whyNoAveragePrecision(report, entry)) +
            " |\n";
  }
  return text + "\nLines touch " + percentText(report.spatial_spread) + " of the image's cells.\n";
}

std::string associationSection(const Report& report) {
  std::string text = "\n## Association";
  if (!report.matches_source.empty()) {
    text += ": " + report.matches_source + " on lines of " + report.matches_lines_source;
  }
  text += "\n\n";
  if (report.pairs.evaluated == 0) {
    return text + whyNoAssociation(report) + "\n";
  }
  text += "| precision | recall | F | pairs |\n| ---: | ---: | ---: | ---: |\n| " +
          ratios(report.association) + " | " + std::to_string(report.pairs.evaluated);
  if (report.pairs_expected) {
    text += " of " + std::to_string(*report.pairs_expected);
  }
  return text + " |\n";
}

}  // namespace

std::string toMarkdown(const Report& report) {
  std::string text = "# Evaluation of " +
                     (report.lines_source.empty() ? "no lines" : report.lines_source) + "\n\n" +
                     programVersion() + ", protocol `" + toString(report.protocol) + "`, pass " +
                     std::to_string(report.pass) +
                     (report.complete ? "" : ", a snapshot before the end of the input") +
                     ". Ratios in percent.\n\n" + coverageLine(report) + "\n";
  const auto wants = [&report](MetricFamily family) { return report.families.count(family) != 0; };
  if (wants(MetricFamily::kDetection)) {
    text += detectionSection(report);
  }
  if (wants(MetricFamily::kHeatmap)) {
    text += heatmapSection(report);
  }
  if (wants(MetricFamily::kRepeatability)) {
    text += repeatabilitySection(report);
  }
  if (wants(MetricFamily::kAssociation)) {
    text += associationSection(report) + detectedAssociationSection(report);
  }
  if (wants(MetricFamily::kPose)) {
    text += poseSection(report);
  }
  if (wants(MetricFamily::kTracks)) {
    text += tracksSection(report);
  }
  text +=
      "\n## Time\n\n| | median ms | 95 % ms | frames/s | frames |\n"
      "| --- | ---: | ---: | ---: | ---: |\n";
  text += timingRow("detector", report.detector_timing);
  text += timingRow("associator", report.associator_timing);
  if (report.run) {
    text += stagesTable(*report.run);
  }
  if (!report.notes.empty()) {
    text += "\n## Notes\n\n";
    for (const std::string& note : report.notes) {
      text += "- " + note + "\n";
    }
  }
  return text;
}

std::string framesToCsv(const Report& report) {
  const bool heatmap = report.families.count(MetricFamily::kHeatmap) != 0;
  std::string text = "stamp,state,lines,ground_truth,detector_ms,spatial_spread";
  for (const DetectionEntry& entry : report.detection) {
    const std::string name = csvName(entry.setting);
    for (const char* figure : {"_true_positives", "_predicted", "_precision", "_recall", "_f_score",
                               "_average_precision"}) {
      text += "," + name + figure;
    }
  }
  for (std::size_t i = 0; heatmap && i < report.heatmap.counts.size(); ++i) {
    const std::vector<double>& thresholds = report.heatmap.score_thresholds;
    const std::string name =
        "heatmap" + (thresholds.empty() ? "" : "_" + formatDouble(thresholds[i]));
    for (const char* figure :
         {"_true_positives", "_predicted", "_ground_truth", "_precision", "_recall", "_f_score"}) {
      text += "," + name + figure;
    }
  }
  text += "\n";
  for (const FrameRecord& frame : report.frames) {
    text += formatStamp(frame.stamp) + "," + toString(frame.state) + "," +
            (frame.lines ? std::to_string(*frame.lines) : "") + "," +
            (frame.ground_truth ? std::to_string(*frame.ground_truth) : "") + "," +
            (frame.processing_time > 0 ? milliseconds(frame.processing_time) : "") + "," +
            (frame.entries.empty() ? "" : formatDouble(frame.spatial_spread));
    for (std::size_t i = 0; i < report.detection.size(); ++i) {
      if (i >= frame.entries.size()) {
        text += ",,,,,,";
        continue;
      }
      const DetectionEntry& entry = frame.entries[i];
      text += "," + std::to_string(entry.counts.true_positives) + "," +
              std::to_string(entry.counts.predicted) + "," +
              formatDouble(entry.counts.precision()) + "," + formatDouble(entry.counts.recall()) +
              "," + formatDouble(entry.counts.fScore()) + "," +
              (entry.average_precision ? formatDouble(*entry.average_precision) : "");
    }
    for (std::size_t i = 0; heatmap && i < report.heatmap.counts.size(); ++i) {
      if (frame.heatmap.empty()) {
        text += ",,,,,,";
        continue;
      }
      const Classification& counts = frame.heatmap[i];
      text += "," + std::to_string(counts.true_positives) + "," + std::to_string(counts.predicted) +
              "," + std::to_string(counts.ground_truth) + "," + formatDouble(counts.precision()) +
              "," + formatDouble(counts.recall()) + "," + formatDouble(counts.fScore());
    }
    text += "\n";
  }
  return text;
}

std::string pairsToCsv(const Report& report) {
  std::string text =
      "first_stamp,stamp,true_positives,predicted,ground_truth,precision,recall,f_score,"
      "associator_ms\n";
  for (const PairRecord& pair : report.pair_records) {
    text += formatStamp(pair.first_stamp) + "," + formatStamp(pair.stamp) + "," +
            std::to_string(pair.counts.true_positives) + "," +
            std::to_string(pair.counts.predicted) + "," + std::to_string(pair.counts.ground_truth) +
            "," + formatDouble(pair.counts.precision()) + "," + formatDouble(pair.counts.recall()) +
            "," + formatDouble(pair.counts.fScore()) + "," +
            (pair.processing_time > 0 ? milliseconds(pair.processing_time) : "") + "\n";
  }
  return text;
}

}  // namespace evolin
