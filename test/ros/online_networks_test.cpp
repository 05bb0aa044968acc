// The nodelet evolin_ros/LineDetector with `mlsd` and `lsdnet`: the lines are those of the plug-in
// alone; a missing model is named.
#include <gtest/gtest.h>
#include <ros/param.h>

#include "conversions.h"
#include "online_stream.h"
#include "plugin_loader.h"
#include "test/support/drawn_sequence.h"
#include "test/support/models.h"

namespace evolin::test {
namespace {

class OnlineNetworks : public ::testing::Test {
 protected:
  OnlineNetworks() : manager_(testNamespace()), publisher_(space()) {}

  const std::string& space() const { return manager_.space(); }

  void choose(const std::string& detector, const std::string& model) {
    ros::param::set(space() + "/detector/detector", detector);
    ros::param::set(space() + "/detector/parameters/model", model);
  }

  void expectLinesOfThePlugin(const std::string& name, const Model& model) {
    PluginLoader loader;
    const std::shared_ptr<LineDetector> detector = loader.loadDetector(name);
    if (!detector->whyUnavailable().empty()) {
      GTEST_SKIP() << detector->whyUnavailable();
    }
    YAML::Node parameters;
    parameters["model"] = model.file.string();
    detector->configure(parameters);
    choose(name, model.file.string());
    ASSERT_TRUE(loadDetector(&manager_));
    Collector<evolin_ros::LineArray> lines(space() + "/lines");
    ASSERT_TRUE(publisher_.waitForListeners(1, 0, 0));
    const SequenceFrame frame = drawFrame({}, 3);
    publisher_.sendImage(frame);
    ASSERT_TRUE(lines.waitForCount(1));
    const evolin_ros::LineArray message = lines.messages().front();
    const LineSegments expected = detector->detect(frame.frame);
    EXPECT_TRUE(message.has_scores);
    EXPECT_EQ(ros_shell::fromRos(message.header.stamp), frame.frame.stamp);
    EXPECT_GT(expected.size(), 4U) << "four quadrilaterals were drawn";
    ASSERT_EQ(message.lines.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(message.lines[i].x1, expected[i].x1) << i;
      EXPECT_EQ(message.lines[i].y2, expected[i].y2) << i;
      EXPECT_EQ(message.lines[i].score, expected[i].score) << i;
    }
  }

  Manager manager_;
  SequencePublisher publisher_;
};

TEST_F(OnlineNetworks, MlsdSendsThePluginsLines) {
  const Model model = mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  expectLinesOfThePlugin("mlsd", model);
}

TEST_F(OnlineNetworks, LsdNetSendsThePluginsLines) {
  const Model model = lsdNetModel();
  EVOLIN_REQUIRE_MODEL(model);
  expectLinesOfThePlugin("lsdnet", model);
}

TEST_F(OnlineNetworks, AMissingModelIsNamedWithWhereToGetIt) {
  choose("mlsd", "no_such_model.onnx");
  if (!whyUnavailable("mlsd").empty()) {
    GTEST_SKIP() << whyUnavailable("mlsd");
  }
  const LogReader log;
  EXPECT_FALSE(loadDetector(&manager_));
  EXPECT_TRUE(
      log.waitFor(rosgraph_msgs::Log::ERROR, {"mlsd", "no_such_model.onnx", "docs/NETWORKS.md"}));
}

}  // namespace
}  // namespace evolin::test
