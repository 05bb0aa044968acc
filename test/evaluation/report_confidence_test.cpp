// Intervals of a report: of the figures that it has, around them, strict in JSON.
#include "evolin_ros/evaluation/report_confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "evolin_ros/evaluation/task.h"
#include "test/evaluation/sample_frames.h"

namespace evolin {
namespace {

using test::handLines;
using test::handTruth;
using test::matchSet;

/// Every third frame has no lines.
PassEvaluation passOf(int frames) {
  PassOptions options;
  PassEvaluation pass(options);
  const TaskRunner runner({options.evaluation.heatmap, options.motion.pose_method});
  for (int frame = 1; frame <= frames; ++frame) {
    LineSet lines = handLines(frame);
    if (frame % 3 == 0) lines.lines.clear();
    pass.addGroundTruth(handTruth(frame));
    for (const EvaluationTask& task : pass.addLines(lines).tasks) {
      pass.addResult(runner.run(task));
    }
    if (frame > 1) {
      const auto odd = static_cast<std::uint32_t>(frame % 2);
      pass.addMatches(matchSet(frame - 1, frame, "ground_truth", {{0, 0}, {1, odd}}));
    }
  }
  return pass;
}

BootstrapOptions resamples(int count) {
  BootstrapOptions options;
  options.resamples = count;
  return options;
}

Report reportOf(int frames, const BootstrapOptions& options) {
  const PassEvaluation pass = passOf(frames);
  Report report = pass.report(true);
  addConfidence(pass.evaluator().detection(), options, &report);
  return report;
}

const FigureInterval* find(const Report& report, const std::string& family,
                           const std::string& figure) {
  for (const FigureInterval& interval : report.confidence->figures) {
    if (interval.family == family && interval.figure == figure) return &interval;
  }
  return nullptr;
}

TEST(AddConfidence, PutsTheFiguresIntoTheirIntervals) {
  const Report report = reportOf(60, resamples(300));
  const auto expectAround = [&](const std::string& family, const std::string& figure,
                                double value) {
    const FigureInterval* interval = find(report, family, figure);
    ASSERT_NE(interval, nullptr) << family << " " << figure;
    EXPECT_LT(interval->interval.low, interval->interval.high) << family << " " << figure;
    EXPECT_LE(interval->interval.low, value) << family << " " << figure;
    EXPECT_GE(interval->interval.high, value) << family << " " << figure;
  };
  expectAround("detection", "recall", report.detection[0].counts.recall());
  expectAround("detection", "f_score", report.detection[0].counts.fScore());
  expectAround("detection", "average_precision", *report.detection[0].average_precision);
  expectAround("heatmap", "recall", report.heatmap.counts[0].recall());
  expectAround("association", "precision", report.association.precision());
  EXPECT_EQ(find(report, "pose", "rotation_median_deg"), nullptr);
  EXPECT_EQ(find(report, "repeatability", "repeatability"), nullptr);
}

TEST(AddConfidence, DrawsForEveryFamilyAsIfItWereAlone) {
  const Report report = reportOf(20, resamples(100));
  const auto expectRecallOf = [&](const std::string& family,
                                  const std::vector<Classification>& counts) {
    const ConfidenceInterval alone = blockBootstrap(
        counts.size(), resamples(100), [&counts](const std::vector<std::uint32_t>& weights) {
          return std::vector<double>{weightedSum(counts, weights).recall()};
        })[0];
    EXPECT_LT(alone.low, alone.high) << family;
    EXPECT_EQ(find(report, family, "recall")->interval.low, alone.low) << family;
    EXPECT_EQ(find(report, family, "recall")->interval.high, alone.high) << family;
  };
  std::vector<Classification> detection;
  std::vector<Classification> heatmap;
  for (const FrameRecord& frame : report.frames) {
    detection.push_back(frame.entries.at(0).counts);
    heatmap.push_back(frame.heatmap.at(0));
  }
  std::vector<Classification> association;
  for (const PairRecord& pair : report.pair_records) {
    association.push_back(pair.counts);
  }
  ASSERT_EQ(detection.size(), 20U) << "as many as of the heatmap";
  ASSERT_EQ(association.size(), 19U);
  expectRecallOf("detection", detection);
  expectRecallOf("heatmap", heatmap);
  expectRecallOf("association", association);
}

TEST(AddConfidence, OfOneFrameIsThatFramesFigure) {
  BootstrapOptions options = resamples(10);
  options.block_length = 7;
  const Report report = reportOf(1, options);
  const FigureInterval* precision = find(report, "detection", "precision");
  ASSERT_NE(precision, nullptr);
  EXPECT_EQ(precision->interval.low, report.detection[0].counts.precision());
  EXPECT_EQ(precision->interval.high, report.detection[0].counts.precision());
}

TEST(AddConfidence, JsonHoldsNumbersOrReasons) {
  Report report = reportOf(9, resamples(20));
  report.confidence->figures[0].interval.high = std::numeric_limits<double>::infinity();
  report.confidence->figures[1].interval.low = std::nan("");
  report.confidence->figures[1].interval.high = std::nan("");
  const auto with = nlohmann::json::parse(toJson(report))["confidence"];
  EXPECT_EQ(with["resamples"], 20);
  EXPECT_EQ(with["level"], 0.95);
  ASSERT_EQ(with["intervals"].size(), report.confidence->figures.size());
  EXPECT_TRUE(with["intervals"][0]["high"].is_null());
  EXPECT_NE(with["intervals"][0]["reason"].get<std::string>().find("infinite"), std::string::npos);
  EXPECT_NE(with["intervals"][1]["reason"].get<std::string>().find("undefined"), std::string::npos);
  EXPECT_EQ(with["intervals"][2]["distance"], "orthogonal");
  EXPECT_TRUE(with["intervals"][2]["low"].is_number());

  const auto without = nlohmann::json::parse(toJson(passOf(2).report(true)))["confidence"];
  EXPECT_TRUE(without["intervals"].is_null());
  EXPECT_FALSE(without["reason"].get<std::string>().empty());
}

}  // namespace
}  // namespace evolin
