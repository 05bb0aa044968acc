// When ~finish answers: once nothing can come any more, where that can be known.
#include <gtest/gtest.h>
#include <ros/param.h>

#include <future>
#include <opencv2/core.hpp>

#include "conversions.h"
#include "evolin_ros/LineArray.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

/// Far longer than any wait of these tests: an answer cannot be due to it.
void setEndlessDrainTimeout() {
  ros::param::set(testNamespace() + "/evaluator/drain_timeout", 1000);
}

/// A frame behind all drawn ones.
SequenceFrame frameBehind(const std::vector<SequenceFrame>& frames) {
  SequenceFrame frame = frames.back();
  frame.frame.stamp += kNanosecondsPerSecond / 100;
  return frame;
}

TEST(OnlineFinish, DoesNotWaitForWhatTheMethodsHaveLeftOut) {
  setEndlessDrainTimeout();
  Bench bench;
  const std::vector<SequenceFrame> frames = drawSequence();
  ASSERT_TRUE(bench.play(frames));
  SequenceFrame unusable = frameBehind(frames);
  // Sent as bgr8, which it is not.
  unusable.frame.image = cv::Mat(unusable.frame.image.size(), CV_8UC2, cv::Scalar::all(90));
  bench.publisher().sendImage(unusable);
  bench.publisher().sendGroundTruth(unusable);
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), true);
  expectCoverage(report, 13, 12, {{"unmatched", 1}});
  EXPECT_EQ(report.at("association").at("pairs"), 11);
}

TEST(OnlineFinish, DoesNotWaitForMatchesOfAStreamShorterThanTheFrameStep) {
  setEndlessDrainTimeout();
  BenchOptions options;
  options.frame_step = 5;
  Bench bench(options);
  std::vector<SequenceFrame> frames = drawSequence();
  frames.resize(3);
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), true);
  expectCoverage(report, 3, 3);
}

TEST(OnlineFinish, WaitsNoLongerThanThereIsSomebodyWhoCouldSend) {
  setEndlessDrainTimeout();
  Bench bench;
  const std::vector<SequenceFrame> frames = drawSequence();
  ASSERT_TRUE(bench.play(frames));
  bench.publisher().sendGroundTruth(frameBehind(frames));
  std::future<std::string> finish =
      std::async(std::launch::async, [&] { return bench.call("finish"); });
  ASSERT_EQ(finish.wait_for(std::chrono::milliseconds(1500)), std::future_status::timeout);
  ASSERT_TRUE(bench.manager().unload("detector"));
  // The associator could still bring the matches of the ground truth without an image.
  ASSERT_EQ(finish.wait_for(std::chrono::milliseconds(1500)), std::future_status::timeout);
  ASSERT_TRUE(bench.manager().unload("associator"));
  EXPECT_EQ(finish.get(), bench.folder() / "report.json");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), true);
  expectCoverage(report, 13, 12, {{"unmatched", 1}});
}

TEST(OnlineFinish, WaitsForTheFirstLinesAgainAfterAReset) {
  setEndlessDrainTimeout();
  BenchOptions options;
  options.associator = "";
  Bench bench(options);
  std::vector<SequenceFrame> frames = drawSequence();
  frames.resize(3);
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  ASSERT_TRUE(bench.manager().unload("detector"));
  bench.call("reset");
  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendGroundTruth(frame);
  }
  // Whose lines may begin at any time; that the old ones' sender is gone says nothing of them.
  std::future<std::string> finish =
      std::async(std::launch::async, [&] { return bench.call("finish"); });
  EXPECT_EQ(finish.wait_for(std::chrono::milliseconds(1500)), std::future_status::timeout);
  ros::Publisher lines =
      ros::NodeHandle(bench.space()).advertise<evolin_ros::LineArray>("lines", 10);
  // The bench listens, too.
  ASSERT_TRUE(waitFor("the evaluator", [&] { return lines.getNumSubscribers() == 2; }));
  for (const SequenceFrame& frame : frames) {
    LineSet set;
    set.stamp = frame.frame.stamp;
    set.source = "another";
    set.width = frame.frame.image.cols;
    set.height = frame.frame.image.rows;
    set.lines = *frame.ground_truth;
    lines.publish(ros_shell::toMessage(set));
  }
  ASSERT_EQ(finish.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), true);
  EXPECT_EQ(report.at("detection").at("source"), "another");
  EXPECT_EQ(report.at("coverage").at("evaluated"), 3);
}

}  // namespace
}  // namespace evolin::test
