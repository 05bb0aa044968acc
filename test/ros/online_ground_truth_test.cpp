// The nodelet evolin_ros/GroundTruth: annotated and recorded lines beside the images that they
// belong to.
#include <gtest/gtest.h>
#include <ros/param.h>

#include "conversions.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

/// Every bit but that of a NaN.
void expectSameLines(const LineSegments& lines, const LineSegments& expected) {
  ASSERT_EQ(lines.size(), expected.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].x1, expected[i].x1) << "line " << i;
    EXPECT_EQ(lines[i].y1, expected[i].y1) << "line " << i;
    EXPECT_EQ(lines[i].x2, expected[i].x2) << "line " << i;
    EXPECT_EQ(lines[i].y2, expected[i].y2) << "line " << i;
    EXPECT_EQ(lines[i].id, expected[i].id) << "line " << i;
    EXPECT_EQ(lines[i].hasScore(), expected[i].hasScore()) << "line " << i;
    if (expected[i].hasScore()) {
      EXPECT_EQ(lines[i].score, expected[i].score) << "line " << i;
    }
  }
}

/// The annotated lines moved by up to some pixels, with scores, as a method might have left them.
std::vector<LineSet> recordedLines(const std::vector<SequenceFrame>& frames) {
  std::vector<LineSet> all;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    LineSet set = groundTruthOf(frames[i]);
    set.source = "recorded";
    set.scored = true;
    for (std::size_t row = 0; row < set.lines.size(); ++row) {
      LineSegment& line = set.lines[row];
      line.x1 += 0.37 * static_cast<double>((row * 7 + i) % 11);
      line.y2 -= 1.1 * static_cast<double>((row + i) % 9);
      line.score = 1.0 / (1.0 + static_cast<double>((row * 5 + i) % 13));
      line.id = kNoId;
    }
    all.push_back(std::move(set));
  }
  return all;
}

/// lines/, scores/ and stamps.txt, as 'evolin detect' leaves them.
void writeRecorded(const std::vector<SequenceFrame>& frames, const std::vector<LineSet>& recorded,
                   const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "lines");
  std::filesystem::create_directories(folder / "scores");
  std::vector<StampedFile> stamps;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string name = frames[i].frame.name + ".csv";
    writeLinesCsv(folder / "lines" / name, recorded[i].lines);
    writeScoresCsv(folder / "scores" / name, recorded[i].lines);
    stamps.push_back({frames[i].frame.stamp, name});
  }
  writeStampsFile(folder / "stamps.txt", stamps);
}

TEST(OnlineGroundTruth, PublishesTheLinesOfEachImage) {
  std::vector<SequenceFrame> frames = drawSequence();
  const TemporaryFolder folder;
  frames[7].ground_truth.reset();  // no entry for this one
  // Ids are chained from frame to frame; written before frame 7 lost its lines they stay whole.
  writeAnnotations(drawSequence(), folder.path());
  std::filesystem::remove(folder.path() / "stamps.txt");
  std::vector<StampedFile> stamps;
  for (const SequenceFrame& frame : frames) {
    if (frame.ground_truth) {
      stamps.push_back({frame.frame.stamp, frame.frame.name + ".csv"});
    }
  }
  writeStampsFile(folder.path() / "stamps.txt", stamps);

  Manager manager(testNamespace());
  const std::string& space = manager.space();
  ros::param::set(space + "/ground_truth_player/folder", folder.path().string());
  ASSERT_TRUE(manager.load("ground_truth_player", "evolin_ros/GroundTruth",
                           {{"ground_truth/lines", "annotated"}}));
  Collector<evolin_ros::LineArray> annotated(space + "/annotated");
  SequencePublisher publisher(space);
  publisher.frame_id = "/openni_rgb_optical_frame";
  ASSERT_TRUE(publisher.waitForListeners(1, 0, 0));
  ASSERT_TRUE(annotated.waitForPublisher());
  const LogReader log;
  for (const SequenceFrame& frame : frames) {
    publisher.sendImage(frame);
  }
  ASSERT_TRUE(annotated.waitForCount(11));
  const std::string microseconds = formatStamp(frames[7].frame.stamp).substr(0, 17);
  ASSERT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"no entry within 0.001 s", microseconds}));

  const std::vector<evolin_ros::LineArray> messages = annotated.messages();
  ASSERT_EQ(messages.size(), 11U);
  std::size_t next = 0;
  for (const SequenceFrame& frame : frames) {
    if (!frame.ground_truth) {
      continue;
    }
    SCOPED_TRACE("frame " + frame.frame.name);
    const evolin_ros::LineArray& message = messages[next++];
    EXPECT_EQ(ros_shell::fromRos(message.header.stamp), frame.frame.stamp);
    EXPECT_EQ(message.header.frame_id, "/openni_rgb_optical_frame");
    EXPECT_EQ(message.source, "ground_truth");
    EXPECT_EQ(message.width, 320U);
    EXPECT_EQ(message.height, 240U);
    EXPECT_FALSE(message.has_scores);
    expectSameLines(ros_shell::fromMessage(message).lines, *frame.ground_truth);
  }
}

TEST(OnlineGroundTruth, PlaysRecordedLinesAsADetector) {
  std::vector<SequenceFrame> frames = drawSequence();
  const std::vector<LineSet> recorded = recordedLines(frames);
  const TemporaryFolder annotations;
  const TemporaryFolder predictions;
  const TemporaryFolder output;
  writeRecorded(frames, recorded, predictions.path());
  frames[5].ground_truth.reset();
  writeAnnotations(frames, annotations.path());

  Manager manager(testNamespace());
  const std::string& space = manager.space();
  ros::param::set(space + "/evaluator/output_dir", output.path().string());
  ros::param::set(space + "/truth/folder", annotations.path().string());
  ros::param::set(space + "/recorded/folder", predictions.path().string());
  ros::param::set(space + "/recorded/source", "recorded");
  ASSERT_TRUE(manager.load("evaluator", "evolin_ros/Evaluator"));
  ASSERT_TRUE(manager.load("truth", "evolin_ros/GroundTruth"));
  ASSERT_TRUE(
      manager.load("recorded", "evolin_ros/GroundTruth", {{"ground_truth/lines", "lines"}}));
  ASSERT_TRUE(manager.waitForListener("lines"));
  ASSERT_TRUE(manager.waitForListener("ground_truth/lines"));
  Collector<evolin_ros::LineArray> lines(space + "/lines");
  SequencePublisher publisher(space);
  ASSERT_TRUE(publisher.waitForListeners(1, 1, 1));
  ASSERT_TRUE(lines.waitForPublisher());
  for (const SequenceFrame& frame : frames) {
    publisher.sendImage(frame);
  }
  ASSERT_TRUE(lines.waitForCount(frames.size()));
  callTrigger(space + "/evaluator/finish");

  const std::vector<evolin_ros::LineArray> messages = lines.messages();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE("frame " + frames[i].frame.name);
    EXPECT_TRUE(messages[i].has_scores);
    EXPECT_EQ(messages[i].source, "recorded");
    EXPECT_EQ(ros_shell::fromRos(messages[i].header.stamp), frames[i].frame.stamp);
    expectSameLines(ros_shell::fromMessage(messages[i]).lines, recorded[i].lines);
  }
  Methods methods;
  methods.associator = "";
  const Expected expected = evaluateLines(frames, recorded, methods);
  const nlohmann::json report = readReport(output.path() / "report.json");
  expectCoverage(report, 12, 11, {{"no_ground_truth", 1}});
  expectDetection(report, expected);
  EXPECT_EQ(report.at("detection").at("source"), "recorded");
}

TEST(OnlineGroundTruth, RefusesAFolderWithoutStampsAndSaysHowToMakeThem) {
  const TemporaryFolder folder;
  writeAnnotations(drawSequence(), folder.path(), false);
  const LogReader log;
  Manager manager(testNamespace());
  ros::param::set(manager.space() + "/truth/folder", folder.path().string());
  EXPECT_FALSE(manager.load("truth", "evolin_ros/GroundTruth"));
  EXPECT_TRUE(log.waitFor(
      rosgraph_msgs::Log::ERROR,
      {folder.path().string(), "stamps.txt", "~stamps", "'evolin bag' writes", "stamp file"}));
}

TEST(OnlineGroundTruth, RefusesAFolderThatIsNotThere) {
  const LogReader log;
  Manager manager(testNamespace());
  EXPECT_FALSE(manager.load("without", "evolin_ros/GroundTruth"));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"'folder'", "not set"}));
  ros::param::set(manager.space() + "/absent/folder", "/nowhere/at/all");
  EXPECT_FALSE(manager.load("absent", "evolin_ros/GroundTruth"));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::ERROR, {"/nowhere/at/all"}));
}

}  // namespace
}  // namespace evolin::test
