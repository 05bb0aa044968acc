// Publishing drawn or recorded frames, and the usual set of nodelets.
#include "online_stream.h"

#include <cv_bridge/cv_bridge.h>
#include <ros/param.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <chrono>

#include "conversions.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {

namespace {

/// Nothing of a short sequence may be lost, however slow the machine is.
constexpr int kQueue = 1000;

void require(const ::testing::AssertionResult& result) {
  if (!result) {
    throw std::runtime_error(result.message());
  }
}

void require(bool loaded, const std::string& nodelet) {
  if (!loaded) {
    throw std::runtime_error(nodelet + " was not loaded; its manager's log says why");
  }
}

}  // namespace

LogReader::LogReader() : log_("/rosout_agg") { require(log_.waitForPublisher()); }

std::vector<std::string> LogReader::find(int level, const std::vector<std::string>& parts) const {
  std::vector<std::string> found;
  for (const rosgraph_msgs::Log& entry : log_.messages()) {
    const bool holds_all = std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
      return entry.msg.find(part) != std::string::npos;
    });
    if (entry.level >= level && holds_all) {
      found.push_back(entry.msg);
    }
  }
  return found;
}

::testing::AssertionResult LogReader::waitFor(int level,
                                              const std::vector<std::string>& parts) const {
  std::string wanted;
  for (const std::string& part : parts) {
    wanted += (wanted.empty() ? "'" : ", '") + part + "'";
  }
  const auto result = ::evolin::test::waitFor("a log entry with " + wanted,
                                              [&] { return !find(level, parts).empty(); });
  if (result) {
    return result;
  }
  auto failure = ::testing::AssertionFailure() << result.message() << "; there are:";
  for (const std::string& text : find(level, {})) {
    failure << "\n  " << text;
  }
  return failure;
}

SequencePublisher::SequencePublisher(const std::string& space) {
  ros::NodeHandle handle(space);
  image_ = handle.advertise<sensor_msgs::Image>("image", kQueue);
  camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", kQueue);
  ground_truth_ = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", kQueue);
}

::testing::AssertionResult SequencePublisher::waitForListeners(unsigned images,
                                                               unsigned camera_infos,
                                                               unsigned ground_truths) {
  const auto there = [&] {
    return image_.getNumSubscribers() == images &&
           camera_info_.getNumSubscribers() == camera_infos &&
           ground_truth_.getNumSubscribers() == ground_truths;
  };
  const auto result = waitFor("listeners", there);
  return result ? result
                : ::testing::AssertionFailure()
                      << result.message() << ": " << image_.getNumSubscribers() << " of " << images
                      << " to images, " << camera_info_.getNumSubscribers() << " of "
                      << camera_infos << " to camera_info, " << ground_truth_.getNumSubscribers()
                      << " of " << ground_truths << " to ground truth";
}

void SequencePublisher::sendImage(const SequenceFrame& frame) {
  std_msgs::Header header;
  header.stamp = ros_shell::toRosTime(frame.frame.stamp);
  header.frame_id = frame_id;
  if (frame.frame.camera) {
    camera_info_.publish(ros_shell::toMessage(*frame.frame.camera, header));
  }
  const std::string& encoding = frame.frame.image.channels() == 1
                                    ? sensor_msgs::image_encodings::MONO8
                                    : sensor_msgs::image_encodings::BGR8;
  image_.publish(cv_bridge::CvImage(header, encoding, frame.frame.image).toImageMsg());
}

void SequencePublisher::sendGroundTruth(const SequenceFrame& frame) {
  if (frame.ground_truth) {
    LineSet set = groundTruthOf(frame);
    set.frame_id = frame_id;
    ground_truth_.publish(ros_shell::toMessage(set));
  }
}

Camera30::Camera30(SequencePublisher* publisher) : thread_([this, publisher] { run(publisher); }) {}

Camera30::~Camera30() {
  stop_ = true;
  thread_.join();
}

void Camera30::run(SequencePublisher* publisher) const {
  const std::vector<SequenceFrame> drawn = drawSequence();
  constexpr Stamp kStep = kNanosecondsPerSecond / 30;
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; !stop_; ++i) {
    SequenceFrame frame = drawn[static_cast<std::size_t>(i) % drawn.size()];
    frame.frame.stamp = drawn.front().frame.stamp + i * kStep;
    publisher->sendImage(frame);
    publisher->sendGroundTruth(frame);
    next += std::chrono::nanoseconds(kStep);
    std::this_thread::sleep_until(next);
  }
}

bool loadDetector(Manager* manager, const std::string& name,
                  const std::map<std::string, std::string>& remappings) {
  return manager->load(name, "evolin_ros/LineDetector", remappings);
}

Bench::Bench(const BenchOptions& options)
    : manager_(testNamespace(), options.threads), publisher_(space()) {
  // All nodelets of a manager share one connection to a topic, so that a lazy one could not be seen
  // to listen.
  for (const char* method : {"detector", "associator"}) {
    ros::param::set(space() + "/" + method + "/lazy", false);
    ros::param::set(space() + "/" + method + "/queue_size", kQueue);
  }
  ros::param::set(space() + "/evaluator/output_dir", folder().string());
  ros::param::set(space() + "/evaluator/save_period", options.save_period);
  ros::param::set(space() + "/evaluator/frame_step", options.frame_step);
  require(manager_.load("evaluator", "evolin_ros/Evaluator"), "evaluator");
  ros::param::set(space() + "/detector/detector", options.detector);
  require(manager_.load("detector", "evolin_ros/LineDetector"), "detector");
  require(manager_.waitForListener("lines"));
  if (!options.associator.empty()) {
    ros::param::set(space() + "/associator/associator", options.associator);
    ros::param::set(space() + "/associator/frame_step", options.frame_step);
    std::map<std::string, std::string> remappings;
    if (options.associated_lines != "lines") {
      remappings["lines"] = options.associated_lines;
    }
    require(manager_.load("associator", "evolin_ros/LineAssociator", remappings), "associator");
    require(manager_.waitForListener("matches"));
  }
  require(publisher_.waitForListeners(1, 1, 1));
}

::testing::AssertionResult Bench::play(const std::vector<SequenceFrame>& frames,
                                       std::size_t in_flight) {
  if (lines_ == nullptr) {
    lines_ = std::make_unique<Collector<evolin_ros::LineArray>>(space() + "/lines");
    const auto connected = lines_->waitForPublisher();
    if (!connected) {
      return connected;
    }
  }
  const std::size_t before = lines_->count();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    publisher_.sendImage(frames[i]);
    publisher_.sendGroundTruth(frames[i]);
    if (i + 1 > in_flight) {
      const auto caught_up = lines_->waitForCount(before + i + 1 - in_flight);
      if (!caught_up) {
        return caught_up;
      }
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace evolin::test
