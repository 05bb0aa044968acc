// Ground truth may come late: the report is the same.
#include <gtest/gtest.h>

#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

TEST(OnlineLateGroundTruth, GivesTheSameReport) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  Collector<evolin_ros::LineArray> lines(bench.space() + "/lines");
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(lines.waitForPublisher());
  ASSERT_TRUE(matches.waitForPublisher());

  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendImage(frame);
  }
  ASSERT_TRUE(lines.waitForCount(frames.size()));
  bench.call("save_report");
  const nlohmann::json before = bench.report();
  expectCoverage(before, 12, 0, {{"waiting", 12}});
  EXPECT_EQ(before.at("complete"), false);
  EXPECT_EQ(matches.count(), 0U);

  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendGroundTruth(frame);
  }
  ASSERT_TRUE(matches.waitForCount(frames.size() - 1));
  bench.call("finish");
  expectWholeReport(bench.report(), evaluateInProcess(frames));
}

TEST(OnlineLateGroundTruth, OutOfOrderGivesTheSameDetection) {
  const std::vector<SequenceFrame> frames = drawSequence();
  BenchOptions options;
  options.associator = "";
  Bench bench(options);
  Collector<evolin_ros::LineArray> lines(bench.space() + "/lines");
  ASSERT_TRUE(lines.waitForPublisher());
  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendImage(frame);
  }
  ASSERT_TRUE(lines.waitForCount(frames.size()));

  // Neighbours exchanged: out of order, but no jump back.
  const std::vector<std::size_t> order = {0, 2, 1, 4, 3, 6, 5, 8, 7, 10, 9, 11};
  for (const std::size_t i : order) {
    bench.publisher().sendGroundTruth(frames[i]);
  }
  bench.call("finish");
  Methods methods;
  methods.associator = "";
  expectWholeReport(bench.report(), evaluateInProcess(frames, methods));
}

}  // namespace
}  // namespace evolin::test
