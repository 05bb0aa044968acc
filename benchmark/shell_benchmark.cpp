// What ROS adds to a method: latency and throughput of the detector's and the associator's nodelet
// in this process against plain calls, on one stream of 640x480 images. Needs a roscore.
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/frames.h"
#include "conversions.h"
#include "evolin_ros/LineArray.h"
#include "evolin_ros/LineMatchArray.h"
#include "plugin_loader.h"

namespace evolin {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFrames = 300;
constexpr double kPatience = 60;  ///< s
constexpr double kMilliseconds = 1000;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What came of one image.
struct Result {
  Clock::time_point when;
  double processing = 0;
};

/// A nodelet in this process, its inputs and its output. Topics are in /shell_benchmark.
template <class Output>
class Stream {
 public:
  /// `type` and parameter are of the nodelet; `lines` of each frame go with its image if the
  /// nodelet reads `lines`.
  Stream(const std::string& type, const std::string& parameter, const std::string& method,
         const std::string& encoding, const std::string& output, std::vector<LineSegments> lines)
      : loader_(false),
        lines_of_frames_(std::move(lines)),
        image_(handle_.advertise<sensor_msgs::Image>(topic("image"), 0)),
        output_(handle_.subscribe(topic(output), 0, &Stream::onOutput, this)) {
    if (!lines_of_frames_.empty()) {
      lines_ = handle_.advertise<evolin_ros::LineArray>(topic("lines"), 0);
    }
    const std::string name = topic(parameter);
    ros::param::set(name + "/" + parameter, method);
    if (!loader_.load(
            name, type,
            {{"image", topic("image")}, {"lines", topic("lines")}, {output, topic(output)}}, {})) {
      throw std::runtime_error("the nodelet does not load");
    }
    const auto begin = Clock::now();
    while (image_.getNumSubscribers() == 0 || (lines_ && lines_.getNumSubscribers() == 0) ||
           output_.getNumPublishers() == 0) {
      if (secondsSince(begin) > kPatience) {
        throw std::runtime_error("the nodelet does not connect");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    for (const Frame& frame : benchmark_frames::load()) {
      sensor_msgs::Image image;
      image.height = static_cast<std::uint32_t>(frame.image.rows);
      image.width = static_cast<std::uint32_t>(frame.image.cols);
      image.encoding = encoding;
      cv::Mat pixels = frame.image;
      if (encoding == sensor_msgs::image_encodings::BGR8) {
        cv::cvtColor(frame.image, pixels, cv::COLOR_GRAY2BGR);
      }
      image.step = static_cast<std::uint32_t>(pixels.step);
      image.data.assign(pixels.datastart, pixels.dataend);
      images_.push_back(image);
    }
  }

  /// New messages as a driver, and a detector, in the same manager would publish them.
  struct Messages {
    boost::shared_ptr<sensor_msgs::Image> image;
    boost::shared_ptr<evolin_ros::LineArray> lines;  ///< null where the nodelet reads none
  };

  Messages make() {
    Messages made;
    const std::size_t frame = sent_ % images_.size();
    made.image = boost::make_shared<sensor_msgs::Image>(images_[frame]);
    made.image->header.stamp = ros::Time(1000) + ros::Duration(0.01 * static_cast<double>(++sent_));
    if (lines_) {
      LineSet set;
      set.lines = lines_of_frames_.at(frame);
      set.source = "benchmark";
      made.lines = boost::make_shared<evolin_ros::LineArray>(ros_shell::toMessage(set));
      made.lines->header = made.image->header;
    }
    return made;
  }

  void publish(const Messages& messages) {
    image_.publish(messages.image);
    if (messages.lines) {
      lines_.publish(messages.lines);
    }
  }

  /// Waits until so many results are there.
  void waitFor(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, std::chrono::duration<double>(kPatience),
                           [&] { return results_.size() >= count; })) {
      throw std::runtime_error("no result for too long");
    }
  }

  std::vector<Result> takeResults() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(results_, {});
  }

 private:
  static std::string topic(const std::string& name) { return "/shell_benchmark/" + name; }

  void onOutput(const boost::shared_ptr<const Output>& message) {
    const Clock::time_point now = Clock::now();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      results_.push_back({now, message->processing_time.toSec()});
    }
    changed_.notify_all();
  }

  ros::NodeHandle handle_;
  nodelet::Loader loader_;
  std::vector<sensor_msgs::Image> images_;
  std::vector<LineSegments> lines_of_frames_;
  std::size_t sent_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Result> results_;
  ros::Publisher image_;
  ros::Publisher lines_;
  ros::Subscriber output_;
};

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// One image at a time: from publishing to the result's arrival, less what the method took.
template <class Output>
void measureLatency(Stream<Output>* stream, const std::string& name) {
  std::vector<double> added;
  std::vector<double> processing;
  for (int i = 0; i < kFrames; ++i) {
    const auto messages = stream->make();
    const auto begin = Clock::now();
    stream->publish(messages);
    stream->waitFor(1);
    const Result result = stream->takeResults().front();
    const double latency = std::chrono::duration<double>(result.when - begin).count();
    processing.push_back(result.processing * kMilliseconds);
    added.push_back(latency * kMilliseconds - processing.back());
  }
  std::printf(
      "%-6s latency: the method %.3f ms (median); the shell adds %.3f ms (median), "
      "%.3f ms (95 %%)\n",
      name.c_str(), percentile(processing, 0.5), percentile(added, 0.5), percentile(added, 0.95));
}

/// Images without pause, at most 8 ahead, against `plain` on the same messages.
template <class Output, class Plain>
void measureThroughput(Stream<Output>* stream, const std::string& name, const Plain& plain) {
  constexpr std::size_t kAhead = 8;
  const auto begin = Clock::now();
  for (std::size_t i = 0; i < kFrames; ++i) {
    stream->publish(stream->make());
    if (i >= kAhead) {
      stream->waitFor(i - kAhead);
    }
  }
  stream->waitFor(kFrames);
  const double online = secondsSince(begin);
  stream->takeResults();

  const auto plain_begin = Clock::now();
  for (int i = 0; i < kFrames; ++i) plain(stream->make());
  const double alone = secondsSince(plain_begin);
  std::printf(
      "%-6s throughput: %.1f images/s through the nodelet, %.1f images/s by plain calls "
      "(%.3f ms a frame more)\n",
      name.c_str(), kFrames / online, kFrames / alone, (online - alone) / kFrames * kMilliseconds);
}

void measureDetector(const std::string& method, const std::string& encoding) {
  using DetectorStream = Stream<evolin_ros::LineArray>;
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(method);
  detector->configure(YAML::Node());
  DetectorStream stream("evolin_ros/LineDetector", "detector", method, encoding, "lines", {});
  measureLatency(&stream, encoding);
  measureThroughput(&stream, encoding, [&](const DetectorStream::Messages& messages) {
    detector->detect(ros_shell::toFrame(messages.image));
  });
}

void measureAssociator(const std::string& method, const std::string& detector_name,
                       const std::string& encoding) {
  using AssociatorStream = Stream<evolin_ros::LineMatchArray>;
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(detector_name);
  detector->configure(YAML::Node());
  std::vector<LineSegments> lines;
  for (const Frame& frame : benchmark_frames::load()) lines.push_back(detector->detect(frame));
  const std::shared_ptr<LineAssociator> associator = loader.loadAssociator(method);
  associator->configure(YAML::Node());

  AssociatorStream stream("evolin_ros/LineAssociator", "associator", method, encoding, "matches",
                          lines);
  stream.publish(stream.make());  // the first frame has nothing before it
  measureLatency(&stream, encoding);
  FrameLines before;
  measureThroughput(&stream, encoding, [&](const AssociatorStream::Messages& messages) {
    FrameLines frame;
    frame.frame = ros_shell::toFrame(messages.image);
    frame.lines = ros_shell::fromMessage(*messages.lines).lines;
    if (!before.frame.image.empty()) associator->match(before, frame);
    before = std::move(frame);
  });
}

int run(const std::string& detector, const std::string& associator) {
  const std::vector<std::string> encodings = {sensor_msgs::image_encodings::MONO8,
                                              sensor_msgs::image_encodings::BGR8};
  std::printf("detector %s, %d images of 640x480\n", detector.c_str(), kFrames);
  for (const std::string& encoding : encodings) measureDetector(detector, encoding);
  std::printf("associator %s on its lines\n", associator.c_str());
  for (const std::string& encoding : encodings) measureAssociator(associator, detector, encoding);
  return 0;
}

}  // namespace
}  // namespace evolin

int main(int argc, char** argv) {
  ros::init(argc, argv, "shell_benchmark");
  if (!ros::master::check()) {
    std::fprintf(stderr, "shell_benchmark: no roscore answers at %s\n",
                 ros::master::getURI().c_str());
    return 1;
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  try {
    return evolin::run(argc > 1 ? argv[1] : "hough_p", argc > 2 ? argv[2] : "lbd");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shell_benchmark: %s\n", error.what());
    return 1;
  }
}
