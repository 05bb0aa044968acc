// Streams of a test: frames out, messages and log entries in, and the usual set of nodelets
// between.
#pragma once

#include <ros/node_handle.h>
#include <rosgraph_msgs/Log.h>

#include <atomic>
#include <boost/shared_ptr.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "evolin_ros/LineArray.h"
#include "evolin_ros/LineMatchArray.h"
#include "evolin_ros/dataset/sequence_reader.h"
#include "online_process.h"
#include "online_support.h"
#include "test/support/temporary_folder.h"

namespace evolin::test {

/// Keeps every message of a topic.
template <class Message>
class Collector {
 public:
  explicit Collector(const std::string& topic)
      : topic_(topic),
        subscriber_(ros::NodeHandle().subscribe<Message>(
            topic, 10000, [this](const boost::shared_ptr<const Message>& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              messages_.push_back(*message);
            })) {}
  ~Collector() { subscriber_.shutdown(); }
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  /// Until then messages are lost.
  ::testing::AssertionResult waitForPublisher() {
    return waitFor("a publisher of " + topic_,
                   [this] { return subscriber_.getNumPublishers() > 0; });
  }

  ::testing::AssertionResult waitForCount(std::size_t count) {
    const auto result = waitFor("message " + std::to_string(count) + " on " + topic_,
                                [&] { return this->count() >= count; });
    return result ? result
                  : ::testing::AssertionFailure() << result.message() << "; got " << this->count();
  }

  unsigned publishers() const { return subscriber_.getNumPublishers(); }

  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.size();
  }

  std::vector<Message> messages() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }

 private:
  std::string topic_;
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  ros::Subscriber subscriber_;
};

/// Everything that nodes log from now on.
class LogReader {
 public:
  /// Throws std::runtime_error when /rosout_agg stays silent.
  LogReader();

  /// Messages of at least `level` that hold all of `parts`.
  std::vector<std::string> find(int level, const std::vector<std::string>& parts) const;

  /// Waits for one; the failure lists what was logged at that level instead.
  ::testing::AssertionResult waitFor(int level, const std::vector<std::string>& parts) const;

 private:
  Collector<rosgraph_msgs::Log> log_;
};

/// The topics of a camera and of its annotation in one namespace.
class SequencePublisher {
 public:
  explicit SequencePublisher(const std::string& space);

  /// Until so many nodes listen to images, camera_info and ground truth; a manager is one node.
  ::testing::AssertionResult waitForListeners(unsigned images, unsigned camera_infos,
                                              unsigned ground_truths);

  /// Image and camera_info.
  void sendImage(const SequenceFrame& frame);

  /// Nothing for a frame without annotation.
  void sendGroundTruth(const SequenceFrame& frame);

  std::string frame_id = "camera_optical";

 private:
  ros::Publisher image_;
  ros::Publisher camera_info_;
  ros::Publisher ground_truth_;
};

/// A camera that runs until the object goes: 30 drawn frames a second of ever later stamps, with
/// their annotation.
class Camera30 {
 public:
  explicit Camera30(SequencePublisher* publisher);
  ~Camera30();
  Camera30(const Camera30&) = delete;
  Camera30& operator=(const Camera30&) = delete;

 private:
  void run(SequencePublisher* publisher) const;

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Loads nodelet evolin_ros/LineDetector, with kDefaultDetector unless its ~detector is set
/// already; false when it does not load.
bool loadDetector(Manager* manager, const std::string& name = "detector",
                  const std::map<std::string, std::string>& remappings = {});

struct BenchOptions {
  std::string detector = kDefaultDetector;
  std::string associator = "lbd";  ///< "": no associator nodelet
  std::string associated_lines = "ground_truth/lines";
  int frame_step = 1;
  double save_period = 5;
  int threads = 4;  ///< of the manager
};

/// Evaluator, detector and associator in a manager, with a publisher that they all listen to.
class Bench {
 public:
  /// Throws std::runtime_error when a nodelet does not start or connect.
  explicit Bench(const BenchOptions& options = {});

  const std::string& space() const { return manager_.space(); }
  Manager& manager() { return manager_; }
  SequencePublisher& publisher() { return publisher_; }
  std::filesystem::path folder() const { return folder_.path(); }
  nlohmann::json report() const { return readReport(folder() / "report.json"); }

  /// Calls ~NAME of the evaluator.
  std::string call(const std::string& name) { return callTrigger(space() + "/evaluator/" + name); }

  /// Image and ground truth of each frame, at most `in_flight` of them ahead of the detector.
  ::testing::AssertionResult play(const std::vector<SequenceFrame>& frames,
                                  std::size_t in_flight = 3);

 private:
  TemporaryFolder folder_;
  Manager manager_;
  SequencePublisher publisher_;
  std::unique_ptr<Collector<evolin_ros::LineArray>> lines_;
};

}  // namespace evolin::test
