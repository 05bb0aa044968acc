// The nodelet evolin_ros/LineAssociator: which frames it pairs and what it sends of them.
#include <gtest/gtest.h>

#include "conversions.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

using Stamps = std::vector<std::pair<Stamp, Stamp>>;

Stamps stampsOf(const std::vector<evolin_ros::LineMatchArray>& messages) {
  Stamps stamps;
  for (const evolin_ros::LineMatchArray& message : messages) {
    stamps.emplace_back(ros_shell::fromRos(message.first_stamp),
                        ros_shell::fromRos(message.header.stamp));
  }
  return stamps;
}

void expectMatches(const evolin_ros::LineMatchArray& message, const MatchSet& expected) {
  EXPECT_EQ(ros_shell::fromRos(message.first_stamp), expected.first_stamp);
  EXPECT_EQ(ros_shell::fromRos(message.header.stamp), expected.stamp);
  EXPECT_EQ(message.header.frame_id, "camera_optical");
  EXPECT_EQ(message.source, "lbd");
  EXPECT_EQ(message.lines_source, expected.lines_source);
  EXPECT_GT(message.processing_time, ros::Duration(0));
  ASSERT_EQ(message.matches.size(), expected.matches.size());
  for (std::size_t i = 0; i < expected.matches.size(); ++i) {
    EXPECT_EQ(message.matches[i].first, expected.matches[i].first);
    EXPECT_EQ(message.matches[i].second, expected.matches[i].second);
    EXPECT_EQ(message.matches[i].distance, expected.matches[i].distance);
  }
}

TEST(OnlineAssociator, PairsFramesAStepApart) {
  const std::vector<SequenceFrame> frames = drawSequence();
  BenchOptions options;
  options.frame_step = 3;
  Bench bench(options);
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(matches.waitForPublisher());
  ASSERT_TRUE(bench.play(frames));
  ASSERT_TRUE(matches.waitForCount(9));
  bench.call("finish");

  Methods methods;
  methods.frame_step = 3;
  std::vector<LineSet> truth;
  truth.reserve(frames.size());
  for (const SequenceFrame& frame : frames) {
    truth.push_back(groundTruthOf(frame));
  }
  const std::vector<MatchSet> expected = associateLines(frames, truth, methods);
  const std::vector<evolin_ros::LineMatchArray> messages = matches.messages();
  ASSERT_EQ(messages.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE("pair " + std::to_string(i));
    expectMatches(messages[i], expected[i]);
  }
  const nlohmann::json report = bench.report();
  expectWholeReport(report, evaluateInProcess(frames, methods));
  EXPECT_EQ(report.at("association").at("pairs_expected"), 9);
}

TEST(OnlineAssociator, DetectedLinesAreNotEvaluatedAndSaidSo) {
  const std::vector<SequenceFrame> frames = drawSequence();
  BenchOptions options;
  options.associated_lines = "lines";
  Bench bench(options);
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(matches.waitForPublisher());
  ASSERT_TRUE(bench.play(frames));
  ASSERT_TRUE(matches.waitForCount(11));
  bench.call("finish");

  const std::vector<MatchSet> expected =
      associateLines(frames, detectLines(frames, kDefaultDetector), {});
  const std::vector<evolin_ros::LineMatchArray> messages = matches.messages();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE("pair " + std::to_string(i));
    expectMatches(messages[i], expected[i]);
  }
  const nlohmann::json report = bench.report();
  const nlohmann::json& association = report.at("association");
  EXPECT_EQ(association.at("reason"), "not evaluated: detected lines");
  EXPECT_TRUE(association.at("f_score").is_null());
  EXPECT_EQ(association.at("pairs"), 0);
  EXPECT_EQ(association.at("not_evaluated").at("detected_lines"), 11);
  EXPECT_EQ(association.at("lines_source"), kDefaultDetector);
  Methods methods;
  methods.associator = "";
  expectDetection(report, evaluateInProcess(frames, methods));
}

TEST(OnlineAssociator, AJumpBackClearsTheWindow) {
  const std::vector<SequenceFrame> frames = drawSequence();
  BenchOptions options;
  options.frame_step = 3;
  Bench bench(options);
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(matches.waitForPublisher());
  ASSERT_TRUE(bench.play({frames.begin() + 4, frames.begin() + 9}));
  ASSERT_TRUE(matches.waitForCount(2));
  ASSERT_TRUE(bench.play({frames.begin(), frames.begin() + 5}));
  ASSERT_TRUE(matches.waitForCount(4));
  bench.call("finish");

  const auto pair = [&](std::size_t first, std::size_t second) {
    return std::make_pair(frames[first].frame.stamp, frames[second].frame.stamp);
  };
  EXPECT_EQ(stampsOf(matches.messages()), (Stamps{pair(4, 7), pair(5, 8), pair(0, 3), pair(1, 4)}));
  EXPECT_EQ(bench.report().at("pass"), 2);
}

}  // namespace
}  // namespace evolin::test
