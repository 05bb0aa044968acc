// Nodelets come and go while messages stream: the manager lives, and what is left works.
#include <gtest/gtest.h>
#include <ros/param.h>

#include <future>

#include "evolin_ros/DetectionMetrics.h"
#include "online_stream.h"
#include "src/ros/conversions.h"
#include "test/support/drawn_sequence.h"
#include "test/support/random_lines.h"

namespace evolin::test {
namespace {

void expectAlive(Manager* manager) {
  const std::optional<int> status = manager->process().wait(0);
  EXPECT_FALSE(status.has_value()) << "the manager ended with status " << *status;
}

TEST(OnlineUnload, AFinishThatWaitsIsBrokenOff) {
  ros::param::set(testNamespace() + "/evaluator/drain_timeout", 1000);
  Bench bench;
  SequencePublisher& publisher = bench.publisher();
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  // Ground truth whose lines never come is waited for.
  SequenceFrame lonely = drawFrame({}, 0);
  lonely.frame.stamp -= kNanosecondsPerSecond;
  publisher.sendGroundTruth(lonely);
  std::future<std::string> finish;
  {
    const Camera30 camera(&publisher);
    ASSERT_TRUE(detection.waitForCount(5));
    finish = std::async(std::launch::async, [&] { return bench.call("finish"); });
    // Long beyond what an answer takes that waits for nothing.
    ASSERT_EQ(finish.wait_for(std::chrono::milliseconds(500)), std::future_status::timeout);

    ASSERT_TRUE(bench.manager().unload("evaluator"));
    ASSERT_EQ(finish.wait_for(std::chrono::seconds(10)), std::future_status::ready);
    // The stream went on; the next evaluator takes it up, in the folder that the first has left.
    const std::size_t before = detection.count();
    ASSERT_TRUE(bench.manager().load("evaluator", "evolin_ros/Evaluator"));
    ASSERT_TRUE(detection.waitForCount(before + 5));
  }
  expectAlive(&bench.manager());
  EXPECT_EQ(finish.get(), bench.folder() / "report.json");
}

/// A frame whose heatmap takes minutes.
evolin_ros::LineArray hugeLines(const std::string& source, std::size_t count) {
  RandomLines random(count);
  LineSet set;
  set.stamp = kNanosecondsPerSecond;
  set.source = source;
  set.width = set.height = 6000;
  set.lines = random.anywhere(count, set.width - 1.0, set.height - 1.0);
  return ros_shell::toMessage(set);
}

TEST(OnlineUnload, AHeatmapOfMinutesHoldsUpNeitherFinishNorUnload) {
  ros::param::set(testNamespace() + "/evaluator/heatmap_budget", 0);
  ros::param::set(testNamespace() + "/evaluator/drain_timeout", 1);
  Bench bench;
  ros::NodeHandle handle(bench.space());
  ros::Publisher lines = handle.advertise<evolin_ros::LineArray>("lines", 10);
  ros::Publisher ground_truth = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", 10);
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(waitFor("the evaluator", [&] {
    return lines.getNumSubscribers() > 0 && ground_truth.getNumSubscribers() > 0;
  }));
  lines.publish(hugeLines("detector", 4000));
  ground_truth.publish(hugeLines("ground_truth", 1000));
  ASSERT_TRUE(detection.waitForCount(1));
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), true);
  EXPECT_EQ(report.at("heatmap").at("pending"), 0);
  expectCoverage(report, 1, 1, {{"heatmap_skipped", 1}});

  bench.call("reset");
  lines.publish(hugeLines("detector", 4000));
  ground_truth.publish(hugeLines("ground_truth", 1000));
  ASSERT_TRUE(detection.waitForCount(2));
  ASSERT_TRUE(bench.manager().unload("evaluator"));
  EXPECT_TRUE(waitFor("the evaluator's end", [&] { return detection.publishers() == 0; }));
  expectAlive(&bench.manager());
}

TEST(OnlineUnload, WhatAnUnloadedEvaluatorHadIsOnDisk) {
  ros::param::set(testNamespace() + "/evaluator/drain_timeout", 1000);
  BenchOptions options;
  options.save_period = 1000;
  Bench bench(options);
  const std::vector<SequenceFrame> frames = drawSequence();
  Collector<evolin_ros::DetectionMetrics> evaluated(bench.space() + "/metrics/detection/frame");
  ASSERT_TRUE(evaluated.waitForPublisher());
  // After the others, or else the detector, which keeps the order, has left it out. Sent before the
  // last of them, so that it has arrived when that one is evaluated.
  SequenceFrame lonely = frames.back();
  lonely.frame.stamp += kNanosecondsPerSecond / 100;
  ASSERT_TRUE(bench.play({frames.begin(), frames.end() - 1}, 0));
  bench.publisher().sendGroundTruth(lonely);
  ASSERT_TRUE(bench.play({frames.back()}, 0));
  ASSERT_TRUE(evaluated.waitForCount(frames.size()));
  auto finish = std::async(std::launch::async, [&] { return bench.call("finish"); });
  ASSERT_EQ(finish.wait_for(std::chrono::milliseconds(500)), std::future_status::timeout);
  ASSERT_TRUE(bench.manager().unload("evaluator"));

  finish.get();
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), false);
  expectCoverage(report, 13, 12, {{"waiting", 1}});
  Methods methods;
  methods.associator = "";
  expectDetection(report, evaluateInProcess(frames, methods));
}

TEST(OnlineUnload, ADetectionThatRunsEndsInPeace) {
  Manager manager(testNamespace());
  const std::string& space = manager.space();
  SequencePublisher publisher(space);
  Collector<evolin_ros::LineArray> lines(space + "/lines");
  for (int round = 1; round <= 2; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    ros::param::set(space + "/slow/detector", "test_slow");
    ros::param::set(space + "/slow/parameters/seconds", 0.5);
    ASSERT_TRUE(loadDetector(&manager, "slow"));
    ASSERT_TRUE(publisher.waitForListeners(1, 0, 0));
    const Camera30 camera(&publisher);
    // Images queue up, so that after one result the detector is at the next image.
    const std::size_t before = lines.count();
    ASSERT_TRUE(lines.waitForCount(before + 1));
    ASSERT_TRUE(manager.unload("slow"));

    // At 30 frames a second the slow one's last detection ends long before these have come.
    ASSERT_TRUE(loadDetector(&manager, "quick"));
    const std::size_t begun = lines.count();
    ASSERT_TRUE(lines.waitForCount(begun + 25));
    expectAlive(&manager);
    ASSERT_TRUE(manager.unload("quick"));
  }
}

TEST(OnlineUnload, TwentyTimesInAStreamLeaveAWorkingManager) {
  Bench bench;
  Manager& manager = bench.manager();
  const std::map<std::string, std::string> lines = {{"lines", "ground_truth/lines"}};
  Collector<evolin_ros::DetectionMetrics> detection(bench.space() + "/metrics/detection/frame");
  {
    const Camera30 camera(&bench.publisher());
    for (int i = 1; i <= 20; ++i) {
      SCOPED_TRACE("time " + std::to_string(i));
      const std::size_t before = detection.count();
      ASSERT_TRUE(detection.waitForCount(before + 1));
      for (const char* name : {"detector", "evaluator"}) {
        ASSERT_TRUE(manager.unload(name));
      }
      ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
      ASSERT_TRUE(loadDetector(&manager));
      if (i % 5 == 0) {
        ASSERT_TRUE(manager.unload("associator"));
        ASSERT_TRUE(manager.load("associator", "evolin_ros/LineAssociator", lines));
      }
      expectAlive(&manager);
    }
  }
  // The stream's last messages go with those who listened to it.
  for (const char* name : {"associator", "detector", "evaluator"}) {
    ASSERT_TRUE(manager.unload(name));
  }
  ASSERT_TRUE(bench.publisher().waitForListeners(0, 0, 0));
  ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
  ASSERT_TRUE(loadDetector(&manager));
  ASSERT_TRUE(manager.load("associator", "evolin_ros/LineAssociator", lines));
  ASSERT_TRUE(manager.waitForListener("lines"));
  ASSERT_TRUE(manager.waitForListener("matches"));
  ASSERT_TRUE(bench.publisher().waitForListeners(1, 1, 1));
  const std::vector<SequenceFrame> frames = drawSequence();
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  expectWholeReport(bench.report(), evaluateInProcess(frames));
}

}  // namespace
}  // namespace evolin::test
