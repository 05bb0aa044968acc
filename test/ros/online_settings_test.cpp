// Settings that change while a detector and an associator run: dynamic_reconfigure and ~reload.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/param.h>

#include <algorithm>

#include "conversions.h"
#include "evolin_ros/geometry/line_selection.h"
#include "online_stream.h"
#include "plugin_loader.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

/// The lines of a method with these parameters.
LineSegments linesOf(const SequenceFrame& frame, const std::string& name,
                     const YAML::Node& parameters) {
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(name);
  detector->configure(parameters);
  return detector->detect(frame.frame);
}

void expectLines(const evolin_ros::LineArray& message, const LineSegments& expected) {
  ASSERT_EQ(message.lines.size(), expected.size());
  for (std::size_t row = 0; row < expected.size(); ++row) {
    EXPECT_EQ(message.lines[row].x1, expected[row].x1) << "row " << row;
    EXPECT_EQ(message.lines[row].y2, expected[row].y2) << "row " << row;
  }
}

/// A detector nodelet with hough_p, a stream of images to it and its lines.
class OnlineSettings : public ::testing::Test {
 protected:
  OnlineSettings()
      : manager_(testNamespace()),
        publisher_(manager_.space()),
        lines_(manager_.space() + "/lines"),
        frames_(drawSequence()) {
    ros::param::set(node_ + "/detector", "hough_p");
    if (!loadDetector(&manager_) || !publisher_.waitForListeners(1, 0, 0)) {
      throw std::runtime_error("no detector");
    }
  }

  /// The lines of the next image.
  evolin_ros::LineArray detectNext() {
    const std::size_t count = lines_.count();
    publisher_.sendImage(frames_.at(next_++));
    EXPECT_TRUE(lines_.waitForCount(count + 1));
    return lines_.messages().back();
  }

  const SequenceFrame& lastFrame() const { return frames_.at(next_ - 1); }

  dynamic_reconfigure::Config reconfigure(const dynamic_reconfigure::Config& config) {
    dynamic_reconfigure::ReconfigureRequest request;
    request.config = config;
    const auto answer =
        tryService<dynamic_reconfigure::Reconfigure>(node_ + "/set_parameters", request);
    EXPECT_TRUE(answer.has_value());
    return answer ? answer->config : dynamic_reconfigure::Config();
  }

  std_srvs::TriggerResponse reload() {
    const auto answer = tryService<std_srvs::Trigger>(node_ + "/reload", {});
    EXPECT_TRUE(answer.has_value());
    return answer.value_or(std_srvs::TriggerResponse());
  }

  Manager manager_;
  SequencePublisher publisher_;
  Collector<evolin_ros::LineArray> lines_;
  std::vector<SequenceFrame> frames_;
  std::size_t next_ = 0;
  const std::string node_ = testNamespace() + "/detector";
};

TEST_F(OnlineSettings, ReconfigureTakesEffectWithTheNextImage) {
  ros::param::set(node_ + "/parameters/threshold", 15);
  ASSERT_TRUE(reload().success);
  const YAML::Node parameters = YAML::Load("{threshold: 15}");
  const evolin_ros::LineArray before = detectNext();
  const LineSegments all = linesOf(lastFrame(), "hough_p", parameters);
  expectLines(before, all);
  ASSERT_GE(all.size(), 2U);
  LineSelection selection;
  selection.min_length = 30;
  selection.max_lines = 1;

  dynamic_reconfigure::Config config;
  config.doubles.resize(1);
  config.doubles[0].name = "min_length";
  config.doubles[0].value = selection.min_length;
  config.ints.resize(1);
  config.ints[0].name = "max_lines";
  config.ints[0].value = 1;
  reconfigure(config);
  const evolin_ros::LineArray after = detectNext();
  const LineSegments expected = selectLines(linesOf(lastFrame(), "hough_p", parameters), selection);
  ASSERT_EQ(expected.size(), 1U);
  expectLines(after, expected);
  EXPECT_EQ(after.source.rfind("hough_p#", 0), 0U) << after.source;
  EXPECT_NE(after.source, before.source);
  double stored = 0;
  ASSERT_TRUE(ros::param::get(node_ + "/min_length", stored));
  EXPECT_EQ(stored, 30);

  // Drawing is no setting of the lines; and what is set back has its old name again.
  dynamic_reconfigure::Config drawing;
  drawing.ints.resize(1);
  drawing.ints[0].name = "line_width";
  drawing.ints[0].value = 4;
  reconfigure(drawing);
  EXPECT_EQ(detectNext().source, after.source);
  config.doubles[0].value = 0;
  config.ints[0].value = 0;
  reconfigure(config);
  EXPECT_EQ(detectNext().source, before.source);
}

TEST_F(OnlineSettings, ReconfigureKeepsToItsRanges) {
  dynamic_reconfigure::Config config;
  config.doubles.resize(1);
  config.doubles[0].name = "min_length";
  config.doubles[0].value = -7;
  const dynamic_reconfigure::Config taken = reconfigure(config);
  const auto length = std::find_if(taken.doubles.begin(), taken.doubles.end(),
                                   [](const auto& entry) { return entry.name == "min_length"; });
  ASSERT_NE(length, taken.doubles.end());
  EXPECT_EQ(length->value, 0);
}

TEST_F(OnlineSettings, ReloadTakesUpOtherParametersAndMethods) {
  EXPECT_EQ(detectNext().source, "hough_p");
  ros::param::set(node_ + "/parameters/threshold", 15);
  ros::param::set(node_ + "/queue_size", 7);
  const std_srvs::TriggerResponse first = reload();
  EXPECT_TRUE(first.success) << first.message;
  EXPECT_NE(first.message.find("only a restart takes up ~queue_size"), std::string::npos)
      << first.message;
  const evolin_ros::LineArray loose = detectNext();
  const LineSegments expected = linesOf(lastFrame(), "hough_p", YAML::Load("{threshold: 15}"));
  EXPECT_GT(expected.size(), linesOf(lastFrame(), "hough_p", YAML::Node()).size());
  expectLines(loose, expected);
  EXPECT_EQ(loose.source.rfind("hough_p#", 0), 0U) << loose.source;
  EXPECT_NE(first.message.find("'" + loose.source + "'"), std::string::npos) << first.message;

  ros::param::del(node_ + "/parameters");
  ros::param::set(node_ + "/detector", "test_slow");
  ros::param::set(node_ + "/min_length", 30.0);
  EXPECT_TRUE(reload().success);
  const evolin_ros::LineArray other = detectNext();
  EXPECT_EQ(other.source.rfind("test_slow#", 0), 0U) << other.source;
  LineSelection selection;
  selection.min_length = 30;
  expectLines(other, selectLines(linesOf(lastFrame(), "hough_p", YAML::Node()), selection));
}

TEST_F(OnlineSettings, WhatIsRefusedLeavesTheOldSettings) {
  const std::string before = detectNext().source;
  ros::param::set(node_ + "/parameters/threshold", "many");
  std_srvs::TriggerResponse answer = reload();
  EXPECT_FALSE(answer.success);
  for (const char* part : {"threshold", "many", "stay as they were"}) {
    EXPECT_NE(answer.message.find(part), std::string::npos) << answer.message;
  }
  EXPECT_EQ(detectNext().source, before);
  ros::param::del(node_ + "/parameters");
  ros::param::set(node_ + "/detector", "hough_q");
  ros::param::set(node_ + "/min_length", 30.0);
  answer = reload();
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("did you mean 'hough_p'"), std::string::npos) << answer.message;
  const evolin_ros::LineArray after = detectNext();
  EXPECT_EQ(after.source, before);
  expectLines(after, linesOf(lastFrame(), "hough_p", YAML::Node()));
}

TEST_F(OnlineSettings, ReloadAnswersWhileAnImageIsWorkedOn) {
  ros::param::set(node_ + "/detector", "test_slow");
  ros::param::set(node_ + "/parameters/seconds", 3.0);
  ASSERT_TRUE(reload().success);
  publisher_.sendImage(frames_[0]);
  publisher_.sendImage(frames_[1]);
  ros::param::set(node_ + "/detector", "hough_p");
  ros::param::del(node_ + "/parameters");
  ASSERT_TRUE(reload().success);
  EXPECT_EQ(lines_.count(), 0U) << "the slow one was done already";
  ASSERT_TRUE(lines_.waitForCount(2));
  // Whether the image had been taken up before the exchange is chance; the second one had not.
  EXPECT_EQ(lines_.messages()[1].source, "hough_p");
}

TEST(OnlineSettingsOfAssociator, ReloadLosesNoPair) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  const std::string node = bench.space() + "/associator";
  Collector<evolin_ros::LineMatchArray> matches(bench.space() + "/matches");
  ASSERT_TRUE(matches.waitForPublisher());
  ASSERT_TRUE(bench.play({frames.begin(), frames.begin() + 6}));
  ASSERT_TRUE(matches.waitForCount(5));
  ros::param::set(node + "/parameters/cross_check", "perhaps");
  const auto refused = tryService<std_srvs::Trigger>(node + "/reload", {});
  ASSERT_TRUE(refused.has_value());
  EXPECT_FALSE(refused->success);
  EXPECT_NE(refused->message.find("cross_check"), std::string::npos) << refused->message;
  ros::param::set(node + "/parameters/cross_check", false);
  callTrigger(node + "/reload");
  ASSERT_TRUE(bench.play({frames.begin() + 6, frames.end()}));
  ASSERT_TRUE(matches.waitForCount(11));
  const std::vector<evolin_ros::LineMatchArray> messages = matches.messages();
  for (std::size_t i = 0; i < messages.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(ros_shell::fromRos(messages[i].first_stamp), frames[i].frame.stamp);
    EXPECT_EQ(messages[i].source == "lbd", i < 5) << messages[i].source;
    EXPECT_EQ(messages[i].lines_source, "ground_truth");
  }
}

}  // namespace
}  // namespace evolin::test
