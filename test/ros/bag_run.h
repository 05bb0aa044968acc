// A bag played through the nodelets, from the player to the report.
#pragma once

#include <ros/param.h>
#include <std_srvs/SetBool.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag_writer.h"
#include "online_stream.h"

namespace evolin::test {

inline void writeBag(const std::vector<SequenceFrame>& frames, const std::filesystem::path& file) {
  BagWriter writer(file);
  for (const SequenceFrame& frame : frames) {
    writer.add(frame);
  }
  writer.close();
}

/// Evaluator, detector and associator on the topics of a bag, and the player. Parameters of the
/// nodelets and of the player below testNamespace() are set before.
class BagRun {
 public:
  explicit BagRun(const std::string& detector) : manager_(testNamespace()) {
    const std::string& space = manager_.space();
    ros::param::set(space + "/evaluator/output_dir", folder_.path().string());
    ros::param::set(space + "/detector/detector", detector);
    ros::param::set(space + "/player/image_topic", "/camera/rgb/image_color");
    ros::param::set(space + "/player/wait_for", std::vector<std::string>{"lines", "matches"});
    ros::param::set(space + "/player/finish", std::vector<std::string>{"evaluator/finish"});
    for (const char* method : {"detector", "associator"}) {
      ros::param::set(space + "/" + method + "/lazy", false);
      ros::param::set(space + "/" + method + "/queue_size", 300);
    }
    EXPECT_TRUE(load("evaluator", "Evaluator"));
    EXPECT_TRUE(load("detector", "LineDetector"));
    EXPECT_TRUE(load("associator", "LineAssociator", {{"lines", "/ground_truth/lines"}}));
  }

  const std::string& space() const { return manager_.space(); }
  std::filesystem::path reportFile() const { return folder_.path() / "report.json"; }

  /// Plays a bag to its end, with `meanwhile` beside it, and gives the report.
  nlohmann::json play(
      const std::filesystem::path& bag, const std::function<void()>& meanwhile = [] {}) {
    ros::param::set(space() + "/player/bag", bag.string());
    Process player({"/usr/bin/python3", EVOLIN_SOURCE_DIR "/scripts/play_bag", "__name:=player",
                    "__ns:=" + space()});
    meanwhile();
    const std::optional<int> status = player.wait(3 * kPatience);
    EXPECT_TRUE(status.has_value()) << "the player did not end in time";
    EXPECT_EQ(status.value_or(-1), 0) << "the player's log says why";
    return readReport(reportFile());
  }

  /// Of the rosbag that the player has started.
  ::testing::AssertionResult setPaused(bool paused) {
    std_srvs::SetBoolRequest request;
    request.data = paused;
    const std::string name = "/" + space().substr(1) + "_player_rosbag/pause_playback";
    const auto answer = tryService<std_srvs::SetBool>(name, request);
    return answer && answer->success != 0 ? ::testing::AssertionSuccess()
                                          : ::testing::AssertionFailure() << name << " refused";
  }

 private:
  bool load(const std::string& name, const std::string& type,
            const std::map<std::string, std::string>& more = {}) {
    std::map<std::string, std::string> remappings = {{"image", "/camera/rgb/image_color"},
                                                     {"camera_info", "/camera/rgb/camera_info"},
                                                     {"depth", "/camera/depth/image"},
                                                     {"ground_truth/lines", "/ground_truth/lines"},
                                                     {"ground_truth/pose", "/ground_truth/pose"}};
    remappings.insert(more.begin(), more.end());
    return manager_.load(name, "evolin_ros/" + type, remappings);
  }

  TemporaryFolder folder_;
  Manager manager_;
};

}  // namespace evolin::test
