// A method that is slower than the camera: what is left out, what is not, and what is told of it.
#include <gtest/gtest.h>
#include <ros/param.h>

#include "conversions.h"
#include "online_diagnostics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;

std::size_t numberOf(const Status& status, const std::string& key) {
  const std::string text = DiagnosticsReader::valueOf(status, key);
  return text.empty() ? 0 : std::stoul(text);
}

/// A detector that takes a fifth of a second, fed with twelve frames at once.
class OnlineRealtime : public ::testing::Test {
 protected:
  OnlineRealtime()
      : manager_(testNamespace()),
        publisher_(space()),
        lines_(space() + "/lines"),
        diagnostics_(space() + "/detector") {
    ros::param::set(node_ + "/detector", "test_slow");
    ros::param::set(node_ + "/parameters/seconds", 0.2);
    ros::param::set(node_ + "/diagnostic_period", 0.1);
  }

  void load() {
    ASSERT_TRUE(loadDetector(&manager_));
    ASSERT_TRUE(publisher_.waitForListeners(1, 0, 0));
  }

  void sendAll() {
    for (const SequenceFrame& frame : frames_) {
      publisher_.sendImage(frame);
    }
  }

  bool lastIsOut() const {
    const std::vector<evolin_ros::LineArray> all = lines_.messages();
    return !all.empty() &&
           ros_shell::fromRos(all.back().header.stamp) == frames_.back().frame.stamp;
  }

  const std::string& space() const { return manager_.space(); }

  Manager manager_;
  SequencePublisher publisher_;
  Collector<evolin_ros::LineArray> lines_;
  DiagnosticsReader diagnostics_;
  const std::vector<SequenceFrame> frames_ = drawSequence();
  const std::string node_ = testNamespace() + "/detector";
};

TEST_F(OnlineRealtime, DropsOldImagesAndCountsThem) {
  const LogReader log;
  ros::param::set(node_ + "/realtime", true);
  load();
  sendAll();
  ASSERT_TRUE(waitFor("the lines of the last image", [&] { return lastIsOut(); }));
  const std::vector<evolin_ros::LineArray> all = lines_.messages();
  ASSERT_LT(all.size(), 6U) << "it fell behind";
  const std::size_t dropped = frames_.size() - all.size();
  EXPECT_TRUE(diagnostics_.waitFor("drops", [&](const Status& status) {
    return status.level == Status::ERROR && numberOf(status, "dropped to keep up") == dropped;
  }));
  EXPECT_TRUE(diagnostics_.waitFor("latency", [&](const Status& status) {
    const double median =
        std::stod("0" + DiagnosticsReader::valueOf(status, "latency, median (ms)"));
    const double late = std::stod("0" + DiagnosticsReader::valueOf(status, "latency, 95 % (ms)"));
    return numberOf(status, "results") == all.size() && median >= 200 && late >= median;
  }));
  EXPECT_TRUE(diagnostics_.waitFor("inputs", [&](const Status& status) {
    return numberOf(status, space() + "/image messages") == frames_.size();
  }));
  ASSERT_TRUE(manager_.unload("detector"));
  EXPECT_TRUE(
      log.waitFor(rosgraph_msgs::Log::INFO, {std::to_string(all.size()) + " images done",
                                             std::to_string(dropped) + " dropped to keep up"}));
}

TEST_F(OnlineRealtime, DropsNothingOtherwise) {
  ros::param::set(node_ + "/diagnostics/queue_warn", 3);
  load();
  sendAll();
  EXPECT_TRUE(diagnostics_.waitFor("queue", [&](const Status& status) {
    return status.level == Status::WARN && numberOf(status, "waiting") >= 3 &&
           DiagnosticsReader::valueOf(status, "capacity") == "no limit";
  }));
  ASSERT_TRUE(lines_.waitForCount(frames_.size()));
  const std::vector<evolin_ros::LineArray> all = lines_.messages();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    EXPECT_EQ(ros_shell::fromRos(all[i].header.stamp), frames_[i].frame.stamp);
  }
  EXPECT_TRUE(diagnostics_.waitFor("queue", [&](const Status& status) {
    return status.level == Status::OK && numberOf(status, "waiting") == 0;
  }));
  EXPECT_TRUE(diagnostics_.waitFor("drops", [&](const Status& status) {
    return status.level == Status::OK && status.message == "nothing was dropped";
  }));
}

TEST_F(OnlineRealtime, ABoundThatIsAskedForIsKeptAndTold) {
  const LogReader log;
  ros::param::set(node_ + "/queue_size", 2);
  load();
  sendAll();
  ASSERT_TRUE(waitFor("the lines of the last image", [&] { return lastIsOut(); }));
  const std::size_t dropped = frames_.size() - lines_.count();
  EXPECT_GE(dropped, 8U);
  EXPECT_TRUE(diagnostics_.waitFor("drops", [&](const Status& status) {
    return numberOf(status, "over ~queue_size") == dropped;
  }));
  EXPECT_TRUE(
      log.waitFor(rosgraph_msgs::Log::WARN, {"~queue_size is 2", "slower than the camera"}));
}

TEST_F(OnlineRealtime, SilenceIsTold) {
  ros::param::set(node_ + "/diagnostics/silence_warn", 0.3);
  ros::param::set(node_ + "/diagnostics/silence_error", 0.9);
  load();
  EXPECT_TRUE(diagnostics_.waitFor("inputs", [&](const Status& status) {
    return status.level == Status::WARN &&
           status.message.find("no message on " + space() + "/image") != std::string::npos;
  }));
  EXPECT_TRUE(diagnostics_.waitFor(
      "inputs", [&](const Status& status) { return status.level == Status::ERROR; }));
  {
    const Camera30 camera(&publisher_);
    EXPECT_TRUE(diagnostics_.waitFor(
        "inputs", [&](const Status& status) { return status.level == Status::OK; }));
  }
}

}  // namespace
}  // namespace evolin::test
