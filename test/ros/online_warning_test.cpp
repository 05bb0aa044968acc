// An expected topic that stays silent is named once, beside what is there instead.
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/param.h>

#include <algorithm>
#include <chrono>

#include "conversions.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

TEST(OnlineWarning, NamesTheSilentTopicAndOnesOfItsType) {
  const LogReader log;
  const TemporaryFolder folder;
  Manager manager(testNamespace());
  const std::string& space = manager.space();
  // Latched, so that it is heard at once.
  ros::Publisher ground_truth =
      ros::NodeHandle().advertise<evolin_ros::LineArray>(space + "/ground_truth/lines", 1, true);
  ground_truth.publish(ros_shell::toMessage(groundTruthOf(drawFrame({}, 0))));
  ros::Publisher elsewhere =
      ros::NodeHandle().advertise<evolin_ros::LineArray>(space + "/frontend/segments", 1);
  const ros::Publisher silent =
      ros::NodeHandle().advertise<evolin_ros::LineArray>(space + "/no_truth", 1);
  const auto is_there = [&] {
    ros::master::V_TopicInfo topics;
    return ros::master::getTopics(topics) &&
           std::any_of(topics.begin(), topics.end(), [&](const ros::master::TopicInfo& topic) {
             return topic.name == space + "/frontend/segments";
           });
  };
  ASSERT_TRUE(waitFor("the master to know the topic", is_there));

  const Clock::time_point begin = Clock::now();
  ros::param::set(space + "/evaluator/output_dir", (folder.path() / "first").string());
  ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
  const std::vector<std::string> wanted = {"no message on " + space + "/lines ",
                                           space + "/frontend/segments"};
  ASSERT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, wanted));
  EXPECT_GE(secondsSince(begin), 3);

  // Another evaluator's warning comes 3 s later: time enough for the first to repeat itself.
  ros::param::set(space + "/second/output_dir", (folder.path() / "second").string());
  ASSERT_TRUE(manager.load("second", "evolin_ros/Evaluator",
                           {{"lines", "nowhere"}, {"ground_truth/lines", "no_truth"}}));
  ASSERT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"no message on " + space + "/nowhere "}));
  // A topic that is there but silent is not called missing, nor one of another type.
  EXPECT_TRUE(log.waitFor(
      rosgraph_msgs::Log::WARN,
      {"no message on " + space + "/no_truth ", "it is advertised but no message has come yet"}));
  EXPECT_TRUE(log.find(rosgraph_msgs::Log::WARN,
                       {"no message on " + space + "/no_truth ", "frontend/segments"})
                  .empty());
  EXPECT_EQ(log.find(rosgraph_msgs::Log::WARN, {"no message on " + space + "/lines "}).size(), 1U);
  // What was heard is not missed.
  EXPECT_EQ(log.find(rosgraph_msgs::Log::WARN, {"no message on " + space + "/ground_truth/lines "})
                .size(),
            0U);
}

}  // namespace
}  // namespace evolin::test
