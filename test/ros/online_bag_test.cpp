// A bag, played by scripts/play_bag through detector, associator and evaluator in one manager,
// gives the figures of an evaluation without any topic between.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "bag_run.h"
#include "evolin_ros/DetectionMetrics.h"
#include "online_diagnostics.h"
#include "test/support/drawn_sequence.h"
#include "test/support/lsd_release.h"
#include "test/support/shared_data.h"

namespace evolin::test {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;

/// What the sha256sum program says of a file.
std::string sha256(const std::filesystem::path& file) {
  const std::unique_ptr<FILE, int (*)(FILE*)> output(
      popen(("sha256sum '" + file.string() + "'").c_str(), "r"), pclose);
  char digits[65] = {};
  return output != nullptr && std::fscanf(output.get(), "%64s", digits) == 1 ? digits : "";
}

TEST(OnlineBag, GivesTheReportOfAnEvaluationInProcess) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const TemporaryFolder folder;
  const std::filesystem::path bag = folder.path() / "drawn.bag";
  writeBag(frames, bag);

  BagRun run(kDefaultDetector);
  const nlohmann::json report = run.play(bag);

  const Expected expected = evaluateInProcess(frames);
  // Figures that tell methods apart: neither nothing nor everything is right.
  ASSERT_GT(expected.detection.front().counts.true_positives, 0U);
  ASSERT_LT(expected.detection.front().counts.fScore(), 1);
  ASSERT_EQ(expected.pairs.size(), 11U);
  expectWholeReport(report, expected);
  EXPECT_EQ(report.at("coverage").at("input_images"), 12);
  EXPECT_EQ(report.at("pass"), 1);
  EXPECT_EQ(report.at("association").at("pairs_expected"), 11);
  const nlohmann::json& parameters = report.at("provenance").at("parameters");
  EXPECT_EQ(parameters.at("input").at("bag"), bag.string());
  EXPECT_EQ(parameters.at("input").at("bytes"), std::filesystem::file_size(bag));
  const std::string hash = sha256(bag);
  ASSERT_EQ(hash.size(), 64U);
  EXPECT_EQ(parameters.at("input").at("sha256"), hash);
  EXPECT_EQ(report.at("timing").at("detector").at("frames"), 12);
  EXPECT_EQ(report.at("timing").at("associator").at("frames"), 11);
}

DrawnSequence fortyFrames() {
  DrawnSequence sequence;
  sequence.frames = 40;
  return sequence;
}

TEST(OnlineBag, AtTenTimesTheSpeedTheReportIsTheSame) {
  const std::vector<SequenceFrame> frames = drawSequence(fortyFrames());
  const TemporaryFolder folder;
  writeBag(frames, folder.path() / "drawn.bag");
  ros::param::set(testNamespace() + "/player/rate", 10.0);
  ros::param::set(testNamespace() + "/evaluator/diagnostic_period", 0.1);
  BagRun run(kDefaultDetector);
  const DiagnosticsReader diagnostics(run.space() + "/evaluator");
  const nlohmann::json report = run.play(folder.path() / "drawn.bag");
  EXPECT_TRUE(diagnostics.waitFor("coverage", [](const Status& status) {
    return DiagnosticsReader::valueOf(status, "seen") == "40" &&
           DiagnosticsReader::valueOf(status, "evaluated") == "40";
  }));
  const Expected expected = evaluateInProcess(frames);
  ASSERT_EQ(expected.pairs.size(), 39U);
  expectWholeReport(report, expected);
  EXPECT_EQ(report.at("coverage").at("input_images"), 40);
  EXPECT_EQ(report.at("provenance").at("parameters").at("input").at("rate"), 10);
}

TEST(OnlineBag, WhatAMethodLosesAtTenTimesTheSpeedIsTold) {
  const std::vector<SequenceFrame> frames = drawSequence(fortyFrames());
  const TemporaryFolder folder;
  writeBag(frames, folder.path() / "drawn.bag");
  const std::string space = testNamespace();
  ros::param::set(space + "/player/rate", 10.0);
  ros::param::set(space + "/detector/parameters/seconds", 0.1);
  ros::param::set(space + "/detector/realtime", true);
  for (const char* node : {"detector", "evaluator"}) {
    ros::param::set(space + "/" + node + "/diagnostic_period", 0.1);
  }
  ros::param::set(space + "/evaluator/diagnostics/in_flight", 0);
  BagRun run("test_slow");
  const DiagnosticsReader evaluator(space + "/evaluator");
  const DiagnosticsReader detector(space + "/detector");
  const nlohmann::json report = run.play(folder.path() / "drawn.bag");
  const nlohmann::json& coverage = report.at("coverage");
  const auto evaluated = coverage.at("evaluated").get<std::size_t>();
  EXPECT_GE(evaluated, 1U);
  EXPECT_LT(evaluated, 20U);
  expectCoverage(report, 40, evaluated, {{"unmatched", 40 - evaluated}});
  EXPECT_EQ(coverage.at("input_images"), 40);
  EXPECT_EQ(report.at("detection").at("frames"), evaluated);
  EXPECT_TRUE(detector.waitFor("drops", [&](const Status& status) {
    return DiagnosticsReader::valueOf(status, "dropped to keep up") ==
           std::to_string(40 - evaluated);
  }));
  EXPECT_TRUE(evaluator.waitFor("coverage", [&](const Status& status) {
    return status.level == Status::ERROR &&
           status.message.find(std::to_string(evaluated) + " of 40 frames that are due") == 0;
  }));
  expectReasons(report);
}

TEST(OnlineBag, APauseIsNoEnd) {
  const std::vector<SequenceFrame> frames = drawSequence(fortyFrames());
  const TemporaryFolder folder;
  writeBag(frames, folder.path() / "drawn.bag");
  const std::string space = testNamespace();
  ros::param::set(space + "/player/rate", 0.5);
  ros::param::set(space + "/evaluator/save_period", 1000);
  ros::param::set(space + "/evaluator/idle_timeout", 0.5);
  ros::param::set(space + "/evaluator/diagnostic_period", 0.1);
  ros::param::set(space + "/evaluator/diagnostics/silence_warn", 0.5);
  BagRun run(kDefaultDetector);
  Collector<evolin_ros::DetectionMetrics> detection(space + "/metrics/detection/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  const DiagnosticsReader diagnostics(space + "/evaluator");
  const nlohmann::json report = run.play(folder.path() / "drawn.bag", [&] {
    ASSERT_TRUE(detection.waitForCount(10));
    ASSERT_TRUE(run.setPaused(true));
    // Only an evaluator without input writes: it saves what there is, and calls it no end.
    ASSERT_TRUE(waitFor("the report of the pause",
                        [&] { return std::filesystem::exists(run.reportFile()); }));
    const nlohmann::json snapshot = readReport(run.reportFile());
    EXPECT_EQ(snapshot.at("complete"), false);
    const auto evaluated = snapshot.at("coverage").at("evaluated").get<std::size_t>();
    EXPECT_GE(evaluated, 10U);
    EXPECT_LT(evaluated, 40U);
    EXPECT_EQ(detection.count(), evaluated);
    EXPECT_TRUE(diagnostics.waitFor("inputs", [](const Status& status) {
      return status.level == Status::WARN &&
             status.message.find("no message on ") != std::string::npos;
    }));
    EXPECT_TRUE(diagnostics.waitFor("coverage", [&](const Status& status) {
      return DiagnosticsReader::valueOf(status, "evaluated") == std::to_string(evaluated);
    }));
    ASSERT_TRUE(run.setPaused(false));
  });
  EXPECT_EQ(report.at("pass"), 1);
  expectWholeReport(report, evaluateInProcess(frames));
}

/// Percent with one decimal, in tenths.
int tenths(const nlohmann::json& ratio) {
  return static_cast<int>(std::lround(1000 * ratio.get<double>()));
}

struct Figures {
  int precision;
  int recall;
  int f_score;
};

const nlohmann::json& entryAt5(const nlohmann::json& report, const std::string& distance) {
  for (const nlohmann::json& entry : report.at("detection").at("entries")) {
    if (entry.at("distance") == distance && entry.at("threshold") == 5) {
      return entry;
    }
  }
  throw std::runtime_error("no entry of the " + distance + " distance at 5");
}

void expectFigures(const nlohmann::json& report, const std::string& distance,
                   const Figures& figures) {
  SCOPED_TRACE(distance);
  const nlohmann::json& entry = entryAt5(report, distance);
  EXPECT_EQ(tenths(entry.at("precision")), figures.precision);
  EXPECT_EQ(tenths(entry.at("recall")), figures.recall);
  EXPECT_EQ(tenths(entry.at("f_score")), figures.f_score);
}

/// Plays the ICL-NUIM sample and checks everything that holds for each detector.
void playSample(const std::string& detector, nlohmann::json* report) {
  SequenceOptions options;
  options.pose_offset = -1;
  options.same_rows = true;  // a row is the same physical line in all frames of the sample
  const auto reader = openSequence(sharedFolder() / "data" / "icl_nuim_lr_sample", options);
  std::vector<SequenceFrame> frames;
  while (std::optional<SequenceFrame> frame = reader->next()) {
    frames.push_back(std::move(*frame));
  }
  ASSERT_EQ(frames.size(), 10U);
  const TemporaryFolder folder;
  writeBag(frames, folder.path() / "icl.bag");

  BagRun run(detector);
  *report = run.play(folder.path() / "icl.bag");

  Methods methods;
  methods.detector = detector;
  const Expected expected = evaluateInProcess(frames, methods);
  expectWholeReport(*report, expected);
  EXPECT_EQ(report->at("coverage").at("evaluated"), 10);
  EXPECT_EQ(report->at("coverage").at("input_images"), 10);
  const nlohmann::json& association = report->at("association");
  EXPECT_EQ(association.at("pairs"), 9);
  EXPECT_EQ(association.at("precision"), 1.0);
  EXPECT_EQ(association.at("recall"), 1.0);
}

class RealSample : public ::testing::Test {
 protected:
  void play(const std::string& detector) { playSample(detector, &report_); }

  nlohmann::json report_;
};

TEST_F(RealSample, HasThePublishedFiguresOfLsd) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = whyUnavailable("opencv_lsd"); !why.empty()) {
    GTEST_SKIP() << why;
  }
  if (const std::string why = whyLsdDiffers(); !why.empty()) {
    GTEST_SKIP() << why;
  }
  ASSERT_NO_FATAL_FAILURE(play("opencv_lsd"));
  expectFigures(report_, "structural", {157, 516, 240});
  expectFigures(report_, "orthogonal", {225, 742, 346});
}

TEST_F(RealSample, HasThePublishedFiguresOfEdLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = whyUnavailable("opencv_edlines"); !why.empty()) {
    GTEST_SKIP() << why;
  }
  ASSERT_NO_FATAL_FAILURE(play("opencv_edlines"));
  expectFigures(report_, "structural", {168, 621, 264});
}

TEST_F(RealSample, HasThePublishedFiguresOfFld) {
  EVOLIN_REQUIRE_SHARED_DATA();
  if (const std::string why = whyUnavailable("opencv_fld"); !why.empty()) {
    GTEST_SKIP() << why;
  }
  ASSERT_NO_FATAL_FAILURE(play("opencv_fld"));
  expectFigures(report_, "structural", {145, 426, 216});
}

}  // namespace
}  // namespace evolin::test
