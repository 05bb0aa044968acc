// Inputs with holes and faults, and graphs other than one evaluator in one namespace.
#include <gtest/gtest.h>
#include <ros/param.h>

#include "conversions.h"
#include "evolin_ros/AssociationMetrics.h"
#include "evolin_ros/Coverage.h"
#include "evolin_ros/DetectionMetrics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

TEST(OnlineSetup, WithoutGroundTruthThereIsNoFigure) {
  std::vector<SequenceFrame> frames = drawSequence();
  for (SequenceFrame& frame : frames) frame.ground_truth.reset();
  BenchOptions options;
  options.associator = "";
  Bench bench(options);
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");

  const nlohmann::json report = bench.report();
  expectCoverage(report, 12, 0, {{"no_ground_truth", 12}});
  const nlohmann::json& detection = report.at("detection");
  EXPECT_EQ(detection.at("frames"), 0);
  const nlohmann::json& entry = detection.at("entries").at(0);
  EXPECT_TRUE(entry.at("f_score").is_null());
  EXPECT_EQ(entry.at("reason"), "no frame was evaluated");
}

TEST(OnlineSetup, GroundTruthOfAThirdOfTheFramesCountsThatThird) {
  std::vector<SequenceFrame> frames = drawSequence();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 3 != 0) frames[i].ground_truth.reset();
  }
  Bench bench;
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");

  const nlohmann::json report = bench.report();
  const Expected expected = evaluateInProcess(frames);
  ASSERT_EQ(expected.frames.size(), 4U);
  ASSERT_EQ(expected.pairs.size(), 3U);
  expectCoverage(report, 12, 4, {{"no_ground_truth", 8}});
  expectDetection(report, expected);
  expectAssociation(report, expected);
}

TEST(OnlineSetup, TwoEvaluatorsKeepTheirSettingsApart) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const LogReader log;
  Bench bench;
  const TemporaryFolder folder;
  const std::string second = bench.space() + "/second";
  ros::param::set(second + "/protocol", "paper");
  ros::param::set(second + "/distance_thresholds", std::vector<double>{2, 7});
  // A folder has one evaluator.
  ros::param::set(second + "/output_dir", bench.folder().string());
  EXPECT_FALSE(bench.manager().load("second", "evolin_ros/Evaluator"));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::FATAL,
                          {bench.folder().string(), bench.space() + "/evaluator (process",
                           "for " + second + " alone"}));
  ros::param::set(second + "/output_dir", folder.path().string());
  ASSERT_TRUE(bench.manager().load("second", "evolin_ros/Evaluator"));
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  callTrigger(second + "/finish");

  EXPECT_EQ(bench.report().at("protocol"), "evolin");
  const Expected expected = evaluateInProcess(frames);
  expectWholeReport(bench.report(), expected);

  EvaluationOptions options;
  options.vectorized.protocol = Protocol::kPaper;
  options.vectorized.distance_thresholds = {2, 7};
  SequenceEvaluator evaluator(options);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    evaluator.addFrame(static_cast<std::uint32_t>(i), expected.lines[i], groundTruthOf(frames[i]));
  }
  Expected other = expected;
  other.detection = evaluator.detectionEntries();
  ASSERT_EQ(other.detection.size(), 4U);
  const nlohmann::json report = readReport(folder.path() / "report.json");
  EXPECT_EQ(report.at("protocol"), "paper");
  expectWholeReport(report, other);
}

TEST(OnlineSetup, OneWorkerThreadIsEnough) {
  DrawnSequence sequence;
  sequence.frames = 6;
  const std::vector<SequenceFrame> frames = drawSequence(sequence);
  BenchOptions options;
  options.detector = "test_slow";
  options.threads = 1;
  Bench bench(options);
  for (const SequenceFrame& frame : frames) {
    bench.publisher().sendImage(frame);
    bench.publisher().sendGroundTruth(frame);
  }
  bench.call("finish");
  Methods methods;
  methods.detector = "hough_p";
  expectWholeReport(bench.report(), evaluateInProcess(frames, methods));
}

TEST(OnlineSetup, RemappedIntoNamespaces) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const TemporaryFolder folder;
  Manager manager(testNamespace());
  const std::string& space = manager.space();
  SequencePublisher publisher(space + "/robot/camera");
  ros::param::set(space + "/robot/frontend/lsd/lazy", false);
  ros::param::set(space + "/robot/frontend/lsd/queue_size", 100);
  ros::param::set(space + "/robot/frontend/lbd/lazy", false);
  ros::param::set(space + "/robot/frontend/lbd/queue_size", 100);
  ros::param::set(space + "/bench/judge/output_dir", folder.path().string());
  ASSERT_TRUE(manager.load("bench/judge", "evolin_ros/Evaluator",
                           {{"bench/lines", "robot/frontend/segments"},
                            {"bench/matches", "robot/frontend/lines/tracks"},
                            {"bench/ground_truth/lines", "robot/camera/ground_truth/lines"},
                            {"bench/camera_info", "robot/camera/camera_info"},
                            {"bench/metrics/detection/frame", "dashboard/detection"}}));
  ASSERT_TRUE(loadDetector(&manager, "robot/frontend/lsd",
                           {{"robot/frontend/image", "robot/camera/image"},
                            {"robot/frontend/lines", "robot/frontend/segments"}}));
  ASSERT_TRUE(manager.load("robot/frontend/lbd", "evolin_ros/LineAssociator",
                           {{"robot/frontend/image", "robot/camera/image"},
                            {"robot/frontend/lines", "robot/camera/ground_truth/lines"},
                            {"robot/frontend/matches", "robot/frontend/lines/tracks"}}));
  Collector<evolin_ros::DetectionMetrics> detection(space + "/dashboard/detection");
  Collector<evolin_ros::AssociationMetrics> association(space + "/bench/metrics/association/frame");
  ASSERT_TRUE(detection.waitForPublisher());
  ASSERT_TRUE(association.waitForPublisher());
  ASSERT_TRUE(publisher.waitForListeners(1, 1, 1));
  for (const SequenceFrame& frame : frames) {
    publisher.sendImage(frame);
    publisher.sendGroundTruth(frame);
  }
  ASSERT_TRUE(detection.waitForCount(12));
  ASSERT_TRUE(association.waitForCount(11));
  const std::filesystem::path file = callTrigger(space + "/bench/judge/finish");
  EXPECT_EQ(file, folder.path() / "report.json");
  expectWholeReport(readReport(file), evaluateInProcess(frames));
}

TEST(OnlineSetup, TwoFrontEndsOnOneTopicAreNamed) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const LogReader log;
  const TemporaryFolder folder;
  Manager manager(testNamespace());
  const std::string& space = manager.space();
  ros::param::set(space + "/evaluator/output_dir", folder.path().string());
  ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
  // Nodelets of one manager are one publisher; what tells them apart is who made the lines.
  SequencePublisher publisher(space);
  for (const std::string name : {"left", "right"}) {
    ros::param::set(space + "/" + name + "/source", "lsd of the " + name);
    ros::param::set(space + "/" + name + "/lazy", false);
    ASSERT_TRUE(loadDetector(&manager, name));
  }
  ASSERT_TRUE(publisher.waitForListeners(1, 1, 1));
  Collector<evolin_ros::LineArray> lines(space + "/lines");
  ASSERT_TRUE(lines.waitForPublisher());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    publisher.sendImage(frames[i]);
    publisher.sendGroundTruth(frames[i]);
    ASSERT_TRUE(lines.waitForCount(2 * (i + 1)));
  }
  callTrigger(space + "/evaluator/finish");
  EXPECT_TRUE(log.waitFor(
      rosgraph_msgs::Log::WARN,
      {space + "/lines (publishers: 1)", "a second message of stamp 1305031453.359684 s",
       "'lsd of the left'", "'lsd of the right'", "does more than one node publish here?"}));
  // Which one comes first in a frame is chance; that one counts, the other is dropped.
  const nlohmann::json report = readReport(folder.path() / "report.json");
  EXPECT_EQ(report.at("pass"), 1);
  expectCoverage(report, 24, 12, {{"dropped", 12}});
  Methods methods;
  methods.associator = "";
  expectDetection(report, evaluateInProcess(frames, methods));
}

TEST(OnlineSetup, InterleavedPublishersAndLinesWithoutAStampAreNamed) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const LogReader log;
  const TemporaryFolder folder;
  Manager manager(testNamespace());
  const std::string& space = manager.space();
  ros::param::set(space + "/evaluator/output_dir", folder.path().string());
  ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
  // A silent publisher in the manager, the second one here.
  ASSERT_TRUE(loadDetector(&manager));
  ros::Publisher lines = ros::NodeHandle().advertise<evolin_ros::LineArray>(space + "/lines", 100);
  ASSERT_TRUE(waitFor("the evaluator", [&] { return lines.getNumSubscribers() == 1; }));
  const std::vector<LineSet> detected = detectLines(frames, "hough_p");
  for (const std::size_t i : {4, 5, 6, 0}) {
    lines.publish(ros_shell::toMessage(detected[i]));
  }
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN,
                          {space + "/lines has 2 publishers", "every jump begins a pass"}));

  callTrigger(space + "/evaluator/reset");
  Collector<evolin_ros::Coverage> coverage(space + "/coverage");
  LineSet set = detected.front();
  set.stamp = 0;
  for (int i = 0; i < 5; ++i) {
    lines.publish(ros_shell::toMessage(set));
  }
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN,
                          {space + "/lines", "a message without a stamp (0 s) is left out"}));
  EXPECT_TRUE(waitFor("five dropped messages", [&] {
    const std::vector<evolin_ros::Coverage> all = coverage.messages();
    return !all.empty() && all.back().dropped == 5 && all.back().seen == 5;
  }));
  EXPECT_EQ(log.find(rosgraph_msgs::Log::WARN, {"without a stamp"}).size(), 1U);
}

TEST(OnlineSetup, ResetEmptiesWhatIsLatchedAndRemovesOldPasses) {
  std::vector<SequenceFrame> frames = drawSequence();
  frames.insert(frames.end(), frames.begin(), frames.begin() + 4);
  BenchOptions options;
  options.associator = "";
  Bench bench(options);
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  ASSERT_EQ(bench.report().at("pass"), 2);
  ASSERT_TRUE(std::filesystem::exists(bench.folder() / "pass_1" / "report.json"));

  bench.call("reset");
  Collector<evolin_ros::Coverage> coverage(bench.space() + "/coverage");
  Collector<evolin_ros::DetectionMetrics> sums(bench.space() + "/metrics/detection/cumulative");
  ASSERT_TRUE(coverage.waitForCount(1));
  ASSERT_TRUE(sums.waitForCount(1));
  EXPECT_EQ(coverage.messages().back().seen, 0U);
  EXPECT_EQ(sums.messages().back().frames, 0U);
  bench.call("save_report");
  EXPECT_EQ(bench.report().at("pass"), 1);
  EXPECT_FALSE(std::filesystem::exists(bench.folder() / "pass_1"));
}

}  // namespace
}  // namespace evolin::test
