// Operating an evaluation: settings that change beneath it, pauses, and what coverage and
// diagnostics say of inputs in trouble.
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <ros/param.h>
#include <std_srvs/SetBool.h>

#include <algorithm>
#include <cmath>

#include "conversions.h"
#include "evolin_ros/Coverage.h"
#include "evolin_ros/DetectionMetrics.h"
#include "evolin_ros/PoseMetrics.h"
#include "evolin_ros/RepeatabilityMetrics.h"
#include "online_diagnostics.h"
#include "online_stream.h"
#include "plugin_loader.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;
using Frames = std::vector<SequenceFrame>;

Frames drawFrames(int count) {
  DrawnSequence sequence;
  sequence.frames = count;
  return drawSequence(sequence);
}

/// A bench without an associator, whose evaluator tells of itself ten times a second.
BenchOptions quickBench(const std::string& detector = "hough_p") {
  ros::param::set(testNamespace() + "/evaluator/diagnostic_period", 0.1);
  ros::param::set(testNamespace() + "/evaluator/diagnostics/in_flight", 2);
  ros::param::set(testNamespace() + "/detector/diagnostic_period", 0.1);
  BenchOptions options;
  options.associator = "";
  options.detector = detector;
  return options;
}

std::vector<LineSet> linesOf(const Frames& frames, const YAML::Node& parameters) {
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector("hough_p");
  detector->configure(parameters);
  std::vector<LineSet> all = detectLines(frames, "hough_p");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    all[i].lines = detector->detect(frames[i].frame);
  }
  return all;
}

Methods withoutAssociator() {
  Methods methods;
  methods.associator = "";
  return methods;
}

TEST(OnlineOperation, OtherSettingsBeginAPassThatKnowsItsOwn) {
  const Frames frames = drawSequence();
  const Frames before(frames.begin(), frames.begin() + 6);
  const Frames after(frames.begin() + 6, frames.end());
  const LogReader log;
  ros::param::set(testNamespace() + "/evaluator/record_parameters",
                  std::vector<std::string>{"detector"});
  Bench bench(quickBench());
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(bench.play(before));
  ASSERT_TRUE(detection.waitForCount(6));
  ros::param::set(bench.space() + "/detector/parameters/threshold", 15);
  callTrigger(bench.space() + "/detector/reload");
  ASSERT_TRUE(bench.play(after));
  ASSERT_TRUE(detection.waitForCount(12));
  bench.call("finish");

  EXPECT_TRUE(log.waitFor(
      rosgraph_msgs::Log::INFO,
      {"the lines are those of 'hough_p#", "no longer those of 'hough_p'", "pass 2 begins"}));
  const nlohmann::json first = readReport(bench.folder() / "pass_1" / "report.json");
  const nlohmann::json second = bench.report();
  EXPECT_EQ(second.at("pass"), 2);
  expectCoverage(first, 6, 6);
  expectCoverage(second, 6, 6);
  expectDetection(first, evaluateLines(before, linesOf(before, YAML::Node()), withoutAssociator()));
  expectDetection(second, evaluateLines(after, linesOf(after, YAML::Load("{threshold: 15}")),
                                        withoutAssociator()));
  EXPECT_EQ(first.at("detection").at("source"), "hough_p");
  EXPECT_NE(second.at("detection").at("source"), "hough_p");
  const std::string key = "parameters of " + bench.space() + "/detector";
  EXPECT_FALSE(first.at("provenance").at(key).contains("parameters"));
  EXPECT_EQ(second.at("provenance").at(key).at("parameters").at("threshold"), 15);
}

TEST(OnlineOperation, WhatComesWhilePausedIsSkippedAndTheReportIsThereForTheAsking) {
  const Frames frames = drawSequence();
  Bench bench(quickBench());
  const DiagnosticsReader diagnostics(bench.space() + "/evaluator");
  const auto report = [&] { return nlohmann::json::parse(bench.call("get_report")); };
  const auto waitForCoverage = [&](const char* name, int count) {
    return waitFor(std::to_string(count) + " frames that are " + name,
                   [&] { return report().at("coverage").at(name) == count; });
  };
  const auto pause = [&](bool paused) {
    std_srvs::SetBoolRequest request;
    request.data = paused ? 1 : 0;
    const auto answer = tryService<std_srvs::SetBool>(bench.space() + "/evaluator/pause", request);
    return answer && answer->success != 0;
  };
  ASSERT_TRUE(bench.play({frames.begin(), frames.begin() + 4}, 0));
  ASSERT_TRUE(waitForCoverage("evaluated", 4));
  ASSERT_TRUE(pause(true));
  ASSERT_TRUE(bench.play({frames.begin() + 4, frames.begin() + 8}, 0));
  ASSERT_TRUE(waitForCoverage("skipped", 4));
  EXPECT_TRUE(diagnostics.waitFor("coverage", [](const Status& status) {
    return status.level == Status::WARN && DiagnosticsReader::valueOf(status, "skipped") == "4" &&
           status.message.find("4 of 8 frames that are due were evaluated") == 0 &&
           status.message.find("; paused") != std::string::npos;
  }));
  ASSERT_TRUE(pause(false));
  ASSERT_TRUE(bench.play({frames.begin() + 8, frames.end()}, 0));
  ASSERT_TRUE(waitForCoverage("evaluated", 8));
  bench.call("finish");
  expectCoverage(bench.report(), 12, 8, {{"skipped", 4}});
  EXPECT_NE(bench.report().dump().find("while the evaluation was paused"), std::string::npos);
}

TEST(OnlineOperation, GroundTruthOfAThirdIsAnErrorOfCoverage) {
  Frames frames = drawFrames(36);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 3 != 0) {
      frames[i].ground_truth.reset();
    }
  }
  Bench bench(quickBench());
  const DiagnosticsReader diagnostics(bench.space() + "/evaluator");
  ASSERT_TRUE(bench.play(frames));
  EXPECT_TRUE(diagnostics.waitFor("coverage", [](const Status& status) {
    return status.level == Status::ERROR &&
           status.message.find("12 of 34 frames that are due were evaluated") == 0;
  }));
  bench.call("finish");
  const nlohmann::json report = bench.report();
  expectCoverage(report, 36, 12, {{"no_ground_truth", 24}});
  Frames known = frames;
  known.erase(std::remove_if(known.begin(), known.end(),
                             [](const SequenceFrame& frame) { return !frame.ground_truth; }),
              known.end());
  expectDetection(report, evaluateLines(known, linesOf(known, YAML::Node()), withoutAssociator()));
  EXPECT_EQ(report.at("heatmap").at("frames"), 12);
  expectReasons(report);
}

TEST(OnlineOperation, WithoutDepthTheFamiliesThatNeedItGiveNoFigure) {
  Bench bench(quickBench());
  const Frames frames = drawSequence();
  ros::Publisher poses = ros::NodeHandle().advertise<geometry_msgs::PoseStamped>(
      bench.space() + "/ground_truth/pose", 100);
  ASSERT_TRUE(waitFor("the evaluator", [&] { return poses.getNumSubscribers() == 1; }));
  for (const SequenceFrame& frame : frames) {
    geometry_msgs::PoseStamped pose;
    pose.header.stamp = ros_shell::toRosTime(frame.frame.stamp);
    pose.pose = ros_shell::toMessage(*frame.frame.pose);
    poses.publish(pose);
  }
  const DiagnosticsReader diagnostics(bench.space() + "/evaluator");
  ASSERT_TRUE(bench.play(frames));
  // Two may be in flight.
  EXPECT_TRUE(diagnostics.waitFor("coverage", [](const Status& status) {
    return status.level == Status::WARN &&
           status.message == "12 of 12 frames that are due were evaluated; 10 without depth";
  }));
  bench.call("finish");
  Collector<evolin_ros::Coverage> coverage(bench.space() + "/coverage");
  Collector<evolin_ros::RepeatabilityMetrics> repeatability(bench.space() +
                                                            "/metrics/repeatability/cumulative");
  Collector<evolin_ros::PoseMetrics> pose(bench.space() + "/metrics/pose/cumulative");
  ASSERT_TRUE(coverage.waitForCount(1));
  EXPECT_EQ(coverage.messages().back().evaluated, 12U);
  EXPECT_EQ(coverage.messages().back().waiting_depth, 12U);
  ASSERT_TRUE(repeatability.waitForCount(1));
  for (const evolin_ros::RepeatabilityEntry& entry : repeatability.messages().back().entries) {
    EXPECT_TRUE(std::isnan(entry.repeatability));
    EXPECT_TRUE(std::isnan(entry.localization_error));
  }
  ASSERT_TRUE(pose.waitForCount(1));
  EXPECT_EQ(pose.messages().back().pairs, 0U);
  EXPECT_TRUE(std::isnan(pose.messages().back().success_rate));
  EXPECT_TRUE(std::isnan(pose.messages().back().rotation_median));
  const nlohmann::json report = bench.report();
  expectCoverage(report, 12, 12, {{"no_depth", 12}, {"no_pose", 0}});
  for (const nlohmann::json& entry : report.at("repeatability").at("entries")) {
    EXPECT_TRUE(entry.at("repeatability").is_null()) << entry;
  }
  EXPECT_TRUE(report.at("pose").at("rotation_median_deg").is_null());
  expectReasons(report);
}

/// A detector of a fifth of a second at 30 images a second.
void expectLossesToBeTold(const char* parameter, int value, const std::string& reason) {
  SCOPED_TRACE(parameter);
  ros::param::set(testNamespace() + "/detector/parameters/seconds", 0.2);
  Bench bench(quickBench("test_slow"));
  // The bench gives its detectors a long queue.
  ASSERT_TRUE(bench.manager().unload("detector"));
  if (value < 0) {
    ros::param::set(bench.space() + "/detector/" + parameter, true);
  } else {
    ros::param::set(bench.space() + "/detector/" + parameter, value);
  }
  ASSERT_TRUE(bench.manager().load("detector", "evolin_ros/LineDetector"));
  ASSERT_TRUE(bench.manager().waitForListener("lines"));
  ASSERT_TRUE(bench.publisher().waitForListeners(1, 1, 1));
  const DiagnosticsReader detector(bench.space() + "/detector");
  const DiagnosticsReader evaluator(bench.space() + "/evaluator");
  const auto countOf = [](const std::optional<Status>& status, const std::string& key) {
    const std::string text = status ? DiagnosticsReader::valueOf(*status, key) : "";
    return text.empty() ? 0 : std::stoi(text);
  };
  {
    const Camera30 camera(&bench.publisher());
    EXPECT_TRUE(detector.waitFor("drops", [&](const Status& status) {
      return status.level == Status::ERROR && countOf(status, reason) >= 20;
    }));
    EXPECT_TRUE(evaluator.waitFor("coverage", [&](const Status& status) {
      return status.level == Status::ERROR && countOf(status, "evaluated") >= 3;
    }));
  }
  bench.call("finish");
  // Every image is heard of; what the detector dropped is what has no lines.
  EXPECT_TRUE(detector.waitFor(
      "queue", [&](const Status& status) { return countOf(status, "waiting") == 0; }));
  const nlohmann::json coverage = bench.report().at("coverage");
  EXPECT_GT(coverage.at("evaluated"), 0);
  EXPECT_GE(coverage.at("unmatched"), 20);
  EXPECT_EQ(coverage.at("evaluated").get<int>() + coverage.at("unmatched").get<int>(),
            coverage.at("seen"));
  EXPECT_TRUE(detector.waitFor("drops", [&](const Status& status) {
    return countOf(status, reason) == coverage.at("unmatched");
  }));
}

TEST(OnlineOperation, ASlowMethodInRealTimeIsTold) {
  expectLossesToBeTold("realtime", -1, "dropped to keep up");
}

TEST(OnlineOperation, AStreamTooFastForAQueueIsTold) {
  expectLossesToBeTold("queue_size", 2, "over ~queue_size");
}

TEST(OnlineOperation, AStreamThatStandsStillIsTold) {
  ros::param::set(testNamespace() + "/evaluator/diagnostics/silence_warn", 0.5);
  Bench bench(quickBench());
  const DiagnosticsReader diagnostics(bench.space() + "/evaluator");
  const Frames frames = drawSequence();
  ASSERT_TRUE(bench.play({frames.begin(), frames.begin() + 5}));
  EXPECT_TRUE(diagnostics.waitFor("inputs", [&](const Status& status) {
    return status.level == Status::WARN &&
           DiagnosticsReader::valueOf(status, bench.space() + "/lines messages") == "5" &&
           status.message.find("no message on " + bench.space()) != std::string::npos;
  }));
  const Camera30 camera(&bench.publisher());
  EXPECT_TRUE(diagnostics.waitFor("inputs",
                                  [](const Status& status) { return status.level == Status::OK; }));
}

}  // namespace
}  // namespace evolin::test
