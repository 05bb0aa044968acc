// A bag that is played in a loop: each pass is evaluated on its own.
#include <gtest/gtest.h>

#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

TEST(OnlineLoop, CountsNothingTwice) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(matches.waitForPublisher());
  for (int pass = 1; pass <= 3; ++pass) {
    ASSERT_TRUE(bench.play(frames));
    // Only the two newest passes are kept, and a detector may be a whole pass ahead of an
    // associator.
    ASSERT_TRUE(matches.waitForCount(static_cast<std::size_t>(pass - 1) * (frames.size() - 1)));
  }
  bench.call("finish");

  const Expected expected = evaluateInProcess(frames);
  const nlohmann::json newest = bench.report();
  EXPECT_EQ(newest.at("pass"), 3);
  expectWholeReport(newest, expected);
  // The last parts of a pass come after the next has begun; its file has them all the same.
  for (const int pass : {1, 2}) {
    SCOPED_TRACE("pass " + std::to_string(pass));
    const nlohmann::json earlier =
        readReport(bench.folder() / ("pass_" + std::to_string(pass)) / "report.json");
    EXPECT_EQ(earlier.at("pass"), pass);
    expectWholeReport(earlier, expected);
  }
}

TEST(OnlineLoop, AJumpBackToTheMiddleBeginsAPass) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const std::vector<SequenceFrame> until_jump(frames.begin(), frames.begin() + 8);
  const std::vector<SequenceFrame> after_jump(frames.begin() + 3, frames.end());
  Bench bench;
  ASSERT_TRUE(bench.play(until_jump));
  ASSERT_TRUE(bench.play(after_jump));
  bench.call("finish");

  const nlohmann::json newest = bench.report();
  EXPECT_EQ(newest.at("pass"), 2);
  const Expected expected = evaluateInProcess(after_jump);
  ASSERT_EQ(expected.frames.size(), 9U);
  expectWholeReport(newest, expected);
  const nlohmann::json earlier = readReport(bench.folder() / "pass_1" / "report.json");
  expectWholeReport(earlier, evaluateInProcess(until_jump));
}

TEST(OnlineLoop, AMessageThatComesTwiceCountsOnce) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const LogReader log;
  Bench bench;
  for (const SequenceFrame& frame : frames) {
    ASSERT_TRUE(bench.play({frame}, 0));
    bench.publisher().sendGroundTruth(frame);
  }
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("pass"), 1);
  const Expected expected = evaluateInProcess(frames);
  expectDetection(report, expected);
  expectAssociation(report, expected);
  expectCoverage(report, 24, 12, {{"dropped", 12}});
  const std::vector<std::string> wanted = {bench.space() + "/ground_truth/lines",
                                           "a second message of stamp 1305031453.359684 s"};
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, wanted));
  EXPECT_EQ(log.find(rosgraph_msgs::Log::WARN, {"a second message"}).size(), 1U);
}

}  // namespace
}  // namespace evolin::test
