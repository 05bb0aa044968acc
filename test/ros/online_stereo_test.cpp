// stereo.launch: two cameras with detectors, associators and evaluators of their own in one
// manager.
#include <gtest/gtest.h>

#include <csignal>

#include "evolin_ros/AssociationMetrics.h"
#include "evolin_ros/DetectionMetrics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

/// The two cameras see different things, each with its own stamps.
std::vector<SequenceFrame> framesOf(const std::string& side) {
  DrawnSequence sequence;
  if (side == "right") {
    sequence.frames = 9;
    sequence.first_stamp += kNanosecondsPerSecond / 100;
  }
  return drawSequence(sequence);
}

/// The camera of one side, and what is said of its lines.
struct Side {
  explicit Side(const std::string& name)
      : name(name),
        frames(framesOf(name)),
        publisher("/" + name),
        detection("/" + name + "/metrics/detection/frame"),
        association("/" + name + "/metrics/association/frame") {}

  std::string name;
  std::vector<SequenceFrame> frames;
  SequencePublisher publisher;
  Collector<evolin_ros::DetectionMetrics> detection;
  Collector<evolin_ros::AssociationMetrics> association;
};

TEST(OnlineStereo, EachCameraHasFiguresOfItsOwn) {
  const TemporaryFolder folder;
  Process launch({"roslaunch", "evolin_ros", "stereo.launch",
                  std::string("detector:=") + kDefaultDetector, "image:=image",
                  "associated_lines:=ground_truth/lines", "lazy:=false",
                  "output_dir:=" + folder.path().string(), "output:=log"});
  Side left("left");
  Side right("right");
  for (Side* side : {&left, &right}) {
    SCOPED_TRACE(side->name);
    ASSERT_TRUE(side->detection.waitForPublisher());
    ASSERT_TRUE(side->association.waitForPublisher());
    ASSERT_TRUE(side->publisher.waitForListeners(1, 1, 1));
    for (const char* topic : {"lines", "matches"}) {
      const std::string name = "/" + side->name + "/" + topic;
      ASSERT_TRUE(waitFor("a listener to " + name,
                          [&] { return listenersOf("/evolin_manager", name) > 0; }));
    }
  }
  for (std::size_t i = 0; i < left.frames.size(); ++i) {
    for (Side* side : {&left, &right}) {
      if (i < side->frames.size()) {
        side->publisher.sendImage(side->frames[i]);
        side->publisher.sendGroundTruth(side->frames[i]);
      }
    }
  }
  for (Side* side : {&left, &right}) {
    SCOPED_TRACE(side->name);
    ASSERT_TRUE(side->detection.waitForCount(side->frames.size()));
    ASSERT_TRUE(side->association.waitForCount(side->frames.size() - 1));
    const std::filesystem::path file = callTrigger("/" + side->name + "/evaluator/finish");
    EXPECT_EQ(file, folder.path() / side->name / "report.json");
    expectWholeReport(readReport(file), evaluateInProcess(side->frames));
  }
  launch.send(SIGINT);
  EXPECT_EQ(launch.wait(kPatience), std::optional<int>(0));
}

}  // namespace
}  // namespace evolin::test
