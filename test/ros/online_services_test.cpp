// The evaluator's services and topics: what they answer and when.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <future>

#include "conversions.h"
#include "evaluation_session.h"
#include "evolin_ros/AssociationMetrics.h"
#include "evolin_ros/Coverage.h"
#include "evolin_ros/DetectionMetrics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

void expectEntry(const evolin_ros::ClassificationEntry& entry, const Classification& counts) {
  EXPECT_NEAR(entry.precision, counts.precision(), 1e-12);
  EXPECT_NEAR(entry.recall, counts.recall(), 1e-12);
  EXPECT_NEAR(entry.f_score, counts.fScore(), 1e-12);
  EXPECT_TRUE(std::isnan(entry.score_threshold));
}

/// The documented order: orthogonal at 5, 10, 15, then structural at 5, 10, 15.
void expectDetectionEntries(const evolin_ros::DetectionMetrics& message,
                            const std::vector<DetectionEntry>& expected) {
  const double thresholds[] = {5, 10, 15};
  ASSERT_EQ(message.entries.size(), 6U);
  ASSERT_EQ(expected.size(), 6U);
  EXPECT_EQ(message.protocol, "evolin");
  for (std::size_t k = 0; k < 6; ++k) {
    SCOPED_TRACE("entry " + std::to_string(k));
    EXPECT_EQ(message.entries[k].name, "vectorized");
    EXPECT_EQ(message.entries[k].distance, k < 3 ? "orthogonal" : "structural");
    EXPECT_EQ(message.entries[k].threshold, thresholds[k % 3]);
    expectEntry(message.entries[k], expected[k].counts);
    if (expected[k].average_precision) {
      EXPECT_NEAR(message.entries[k].average_precision, *expected[k].average_precision, 1e-12);
    } else {
      EXPECT_TRUE(std::isnan(message.entries[k].average_precision));
    }
  }
}

TEST(OnlineServices, MetricsOfEachFrameAndPairAreSentAsTheyCome) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const Expected expected = evaluateInProcess(frames);
  Bench bench;
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  Collector<evolin_ros::AssociationMetrics> association(bench.space() +
                                                        "/metrics/association/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(association.waitForPublisher());
  ASSERT_TRUE(bench.play(frames));
  ASSERT_TRUE(detection.waitForCount(12));
  ASSERT_TRUE(association.waitForCount(11));

  const std::vector<evolin_ros::DetectionMetrics> frame_messages = detection.messages();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE("frame " + frames[i].frame.name);
    EXPECT_EQ(ros_shell::fromRos(frame_messages[i].header.stamp), frames[i].frame.stamp);
    EXPECT_EQ(frame_messages[i].frames, 1U);
    EXPECT_FALSE(frame_messages[i].cumulative);
    expectDetectionEntries(frame_messages[i], expected.frames[i].entries);
  }
  const std::vector<evolin_ros::AssociationMetrics> pair_messages = association.messages();
  for (std::size_t i = 0; i < expected.pairs.size(); ++i) {
    SCOPED_TRACE("pair " + std::to_string(i));
    EXPECT_EQ(ros_shell::fromRos(pair_messages[i].header.stamp), expected.pairs[i].stamp);
    EXPECT_FALSE(pair_messages[i].cumulative);
    ASSERT_EQ(pair_messages[i].entries.size(), 1U);
    expectEntry(pair_messages[i].entries[0], expected.pairs[i].counts);
    EXPECT_TRUE(std::isnan(pair_messages[i].entries[0].average_precision));
  }
}

TEST(OnlineServices, SumsAreLatched) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const Expected expected = evaluateInProcess(frames);
  Bench bench;
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");

  // Whoever comes after the end still gets the last one.
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() +
                                                    "/metrics/detection/cumulative");
  Collector<evolin_ros::AssociationMetrics> association(bench.space() +
                                                        "/metrics/association/cumulative");
  Collector<evolin_ros::Coverage> coverage(bench.space() + "/coverage");
  ASSERT_TRUE(detection.waitForCount(1));
  ASSERT_TRUE(association.waitForCount(1));
  ASSERT_TRUE(coverage.waitForCount(1));
  const evolin_ros::DetectionMetrics sums = detection.messages().front();
  EXPECT_TRUE(sums.cumulative);
  EXPECT_EQ(sums.frames, 12U);
  expectDetectionEntries(sums, expected.detection);
  const evolin_ros::AssociationMetrics pairs = association.messages().front();
  EXPECT_TRUE(pairs.cumulative);
  EXPECT_EQ(pairs.frames, 11U);
  ASSERT_EQ(pairs.entries.size(), 1U);
  EXPECT_EQ(pairs.entries[0].name, "association");
  expectEntry(pairs.entries[0], expected.association);
  const evolin_ros::Coverage counts = coverage.messages().front();
  EXPECT_EQ(counts.seen, 12U);
  EXPECT_EQ(counts.evaluated, 12U);
  EXPECT_EQ(counts.unmatched + counts.dropped + counts.no_ground_truth + counts.bad_ground_truth +
                counts.skipped,
            0U);
}

TEST(OnlineServices, SaveReportWritesWhatThereIs) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const std::vector<SequenceFrame> half(frames.begin(), frames.begin() + 6);
  BenchOptions options;
  options.save_period = 1000;
  Bench bench(options);
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  Collector<evolin_ros::AssociationMetrics> association(bench.space() +
                                                        "/metrics/association/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(association.waitForPublisher());
  ASSERT_TRUE(bench.play(half));
  ASSERT_TRUE(detection.waitForCount(6));
  ASSERT_TRUE(association.waitForCount(5));

  const std::filesystem::path file = bench.call("save_report");
  EXPECT_EQ(file, bench.folder() / "report.json");
  const nlohmann::json report = readReport(file);
  EXPECT_EQ(report.at("complete"), false);
  const Expected expected = evaluateInProcess(half);
  expectCoverage(report, 6, 6);
  expectDetection(report, expected);
  expectAssociation(report, expected);
}

TEST(OnlineServices, ResetForgetsEverything) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  ASSERT_TRUE(bench.play({frames.begin(), frames.begin() + 7}));
  bench.call("finish");
  ASSERT_EQ(bench.report().at("coverage").at("seen"), 7);

  bench.call("reset");
  bench.call("save_report");
  expectCoverage(bench.report(), 0, 0);
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("pass"), 1);
  expectWholeReport(report, evaluateInProcess(frames));
}

TEST(OnlineServices, FinishWaitsForASlowDetector) {
  DrawnSequence sequence;
  sequence.frames = 8;
  const std::vector<SequenceFrame> frames = drawSequence(sequence);
  BenchOptions options;
  options.detector = "test_slow";
  Bench bench(options);
  const auto begin = std::chrono::steady_clock::now();
  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendImage(frame);
    bench.publisher().sendGroundTruth(frame);
  }
  bench.call("finish");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(2400));

  const nlohmann::json report = bench.report();
  Methods methods;
  methods.detector = "hough_p";
  expectWholeReport(report, evaluateInProcess(frames, methods));
  EXPECT_EQ(report.at("detection").at("source"), "test_slow");
  EXPECT_GE(report.at("timing").at("detector").at("latency_ms").at("median"), 300);
  EXPECT_LE(report.at("timing").at("detector").at("rate_hz"), 1 / 0.3);
}

TEST(OnlineServices, AnIdleEvaluatorSavesByItself) {
  const std::vector<SequenceFrame> frames = drawSequence();
  BenchOptions options;
  options.save_period = 1000;
  Bench bench(options);
  ASSERT_TRUE(bench.play(frames));
  ASSERT_TRUE(waitFor("the report of an idle evaluator",
                      [&] { return std::filesystem::exists(bench.folder() / "report.json"); }));
  expectCoverage(bench.report(), 12, 12);
}

TEST(OnlineServices, SavingNeverWaitsForAnotherThatWrites) {
  const TemporaryFolder folder;
  ros_shell::EvaluatorOptions options;
  options.output_dir = (folder.path() / "results").string();
  options.idle_timeout = 0;
  std::promise<void> writes;
  std::promise<void> go_on;
  std::atomic<int> errors{0};
  ros_shell::EvaluationSession::Log log;
  log.warning = [](const std::string& /*text*/) {};
  log.error = [&](const std::string& /*text*/) {
    if (errors++ == 0) {
      writes.set_value();
      go_on.get_future().wait();
    }
  };
  ros::NodeHandle handle(testNamespace());
  const ros::NodeHandle private_handle(testNamespace() + "/evaluator");
  ros_shell::EvaluationSession session(handle, private_handle, options, "/evaluator", log);
  std_msgs::Header header;
  header.stamp = ros::Time(5);
  session.take(header, [](StreamEvaluator* evaluator) { return evaluator->addImage(5000000000); });
  // A folder that is none any more: the first one to save has something to tell, and is held there.
  std::filesystem::remove_all(options.output_dir);
  std::ofstream(options.output_dir) << "in the way";
  std::future<void> first = std::async(std::launch::async, [&] { session.saveChanges(); });
  ASSERT_EQ(writes.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
  std::future<void> others = std::async(std::launch::async, [&] {
    session.saveChanges();
    session.saveWhenIdle();
  });
  EXPECT_EQ(others.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  EXPECT_EQ(first.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  go_on.set_value();
  first.get();
  others.get();
  std::filesystem::remove(options.output_dir);
  session.saveChanges();
  EXPECT_EQ(readReport(std::filesystem::path(options.output_dir) / "report.json")
                .at("coverage")
                .at("seen"),
            1)
      << "what could not be written before is not forgotten";
}

}  // namespace
}  // namespace evolin::test
