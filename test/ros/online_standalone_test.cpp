// The whole chain in processes of their own: as plain nodes and under 'nodelet standalone'.
#include <gtest/gtest.h>
#include <ros/param.h>

#include <csignal>
#include <memory>

#include "conversions.h"
#include "evolin_ros/AssociationMetrics.h"
#include "evolin_ros/DetectionMetrics.h"
#include "online_diagnostics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

/// How the nodelet `type` is started as `name`.
using Command =
    std::function<std::vector<std::string>(const std::string& name, const std::string& type)>;

/// Ground truth comes from a folder, so that all four take part.
void expectWholeChain(const Command& command) {
  const std::string space = testNamespace();
  const std::vector<SequenceFrame> frames = drawSequence();
  const TemporaryFolder annotations;
  const TemporaryFolder results;
  writeAnnotations(frames, annotations.path());
  for (const char* method : {"detector", "associator"}) {
    ros::param::set(space + "/" + method + "/lazy", false);
    ros::param::set(space + "/" + method + "/queue_size", 100);
  }
  ros::param::set(space + "/detector/detector", kDefaultDetector);
  ros::param::set(space + "/truth/folder", annotations.path().string());
  ros::param::set(space + "/evaluator/output_dir", results.path().string());
  std::vector<std::unique_ptr<Process>> processes;
  const auto run = [&](const std::string& name, const std::string& type,
                       const std::string& remapping = "") {
    std::vector<std::string> words = command(name, type);
    words.push_back("__ns:=" + space);
    if (!remapping.empty()) {
      words.push_back(remapping);
    }
    processes.push_back(std::make_unique<Process>(words));
  };
  run("evaluator", "Evaluator");
  run("detector", "LineDetector");
  run("associator", "LineAssociator", "lines:=ground_truth/lines");
  run("truth", "GroundTruth");

  SequencePublisher publisher(space);
  Collector<evolin_ros::LineArray> lines(space + "/lines");
  Collector<evolin_ros::LineArray> truth(space + "/ground_truth/lines");
  Collector<evolin_ros::DetectionMetrics> detection(space + "/metrics/detection/frame");
  Collector<evolin_ros::AssociationMetrics> association(space + "/metrics/association/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(association.waitForPublisher());
  ASSERT_TRUE(publisher.waitForListeners(3, 1, 3));
  const auto connected = [&](const std::string& name, const std::string& topic, std::size_t count) {
    return waitFor("listeners to " + topic,
                   [&] { return listenersOf(space + "/" + name, space + "/" + topic) == count; });
  };
  ASSERT_TRUE(connected("detector", "lines", 2));
  ASSERT_TRUE(connected("truth", "ground_truth/lines", 3));
  ASSERT_TRUE(connected("associator", "matches", 1));
  for (const SequenceFrame& frame : frames) {
    publisher.sendImage(frame);
  }
  ASSERT_TRUE(detection.waitForCount(frames.size()));
  ASSERT_TRUE(association.waitForCount(frames.size() - 1));
  callTrigger(space + "/evaluator/finish");
  expectWholeReport(readReport(results.path() / "report.json"), evaluateInProcess(frames));
  for (const std::unique_ptr<Process>& process : processes) {
    process->send(SIGINT);
  }
  for (const std::unique_ptr<Process>& process : processes) {
    EXPECT_EQ(process->wait(kPatience), std::optional<int>(0));
  }
}

std::vector<std::string> standalone(const std::string& name, const std::string& type) {
  return {"rosrun", "nodelet", "nodelet", "standalone", "evolin_ros/" + type, "__name:=" + name};
}

std::vector<std::string> plainNode(const std::string& name, const std::string& type) {
  const std::map<std::string, std::string> programs = {{"Evaluator", "evaluator_node"},
                                                       {"GroundTruth", "ground_truth_node"},
                                                       {"LineAssociator", "line_associator_node"},
                                                       {"LineDetector", "line_detector_node"}};
  return {"rosrun", "evolin_ros", programs.at(type), "__name:=" + name};
}

TEST(OnlineStandalone, NodeletsWorkAlone) { expectWholeChain(standalone); }

TEST(OnlineStandalone, PlainNodesWork) { expectWholeChain(plainNode); }

/// The adapters and viewers, which are no part of the chain.
TEST(OnlineStandalone, EveryPlainNodeRunsUntilItIsInterrupted) {
  const std::string space = testNamespace();
  for (const std::string program : {"line_viewer_node", "lines_3d_node", "marker_lines_node",
#ifdef EVOLIN_HAS_OPENCV_APPS
                                    "opencv_apps_lines_node",
#endif
                                    "point_cloud_lines_node"}) {
    const DiagnosticsReader diagnostics(space + "/" + program);
    Process process({"rosrun", "evolin_ros", program, "__name:=" + program, "__ns:=" + space});
    EXPECT_TRUE(diagnostics.waitFor("inputs", [](const auto&) { return true; })) << program;
    process.send(SIGINT);
    EXPECT_EQ(process.wait(kPatience), std::optional<int>(0)) << program;
  }
}

TEST(OnlineStandalone, APlainNodeThatRefusesEndsWithAnError) {
  ros::param::set(testNamespace() + "/detector/detector", "hough_q");
  std::vector<std::string> words = plainNode("detector", "LineDetector");
  words.push_back("__ns:=" + testNamespace());
  Process process(words);
  EXPECT_EQ(process.wait(kPatience), std::optional<int>(1));
}

}  // namespace
}  // namespace evolin::test
