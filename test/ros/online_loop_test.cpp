// A bag that is played in a loop: each pass is evaluated on its own.
#include <gtest/gtest.h>

#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

TEST(OnlineLoop, CountsNothingTwice) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  std::vector<SequenceFrame> three_passes;
  for (int pass = 0; pass < 3; ++pass) {
    three_passes.insert(three_passes.end(), frames.begin(), frames.end());
  }
  ASSERT_TRUE(bench.play(three_passes));
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

TEST(OnlineLoop, AMessageThatComesTwiceCountsOnce) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  for (const SequenceFrame& frame : frames) {
    ASSERT_TRUE(bench.play({frame}, 0));
    bench.publisher().sendGroundTruth(frame);
  }
  bench.call("finish");
  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("pass"), 1);
  expectWholeReport(report, evaluateInProcess(frames));
}

}  // namespace
}  // namespace evolin::test
