// What ROS adds to a detector: latency and throughput of the detector nodelet in this process
// against the plain call, on one stream of 640x480 images. Needs a roscore.
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

/// A nodelet in this process, its input and its output.
class Stream {
 public:
  Stream(const std::string& detector, std::string encoding)
      : encoding_(std::move(encoding)),
        loader_(false),
        image_(handle_.advertise<sensor_msgs::Image>("shell_benchmark/image", 0)),
        lines_(handle_.subscribe("shell_benchmark/lines", 0, &Stream::onLines, this)) {
    ros::param::set("/shell_benchmark/detector/detector", detector);
    if (!loader_.load("/shell_benchmark/detector", "evolin_ros/LineDetector",
                      {{"image", "/shell_benchmark/image"}, {"lines", "/shell_benchmark/lines"}},
                      {})) {
      throw std::runtime_error("the nodelet does not load");
    }
    const auto begin = Clock::now();
    while (image_.getNumSubscribers() == 0 || lines_.getNumPublishers() == 0) {
      if (secondsSince(begin) > kPatience) {
        throw std::runtime_error("the nodelet does not connect");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    for (const Frame& frame : benchmark_frames::load()) {
      sensor_msgs::Image image;
      image.height = static_cast<std::uint32_t>(frame.image.rows);
      image.width = static_cast<std::uint32_t>(frame.image.cols);
      image.encoding = encoding_;
      cv::Mat pixels = frame.image;
      if (encoding_ == sensor_msgs::image_encodings::BGR8) {
        cv::cvtColor(frame.image, pixels, cv::COLOR_GRAY2BGR);
      }
      image.step = static_cast<std::uint32_t>(pixels.step);
      image.data.assign(pixels.datastart, pixels.dataend);
      images_.push_back(image);
    }
  }

  /// A new message as a driver in the same manager would publish it.
  boost::shared_ptr<sensor_msgs::Image> makeImage() {
    auto message = boost::make_shared<sensor_msgs::Image>(images_[sent_ % images_.size()]);
    message->header.stamp = ros::Time(1000) + ros::Duration(0.01 * static_cast<double>(++sent_));
    return message;
  }

  void publish(const boost::shared_ptr<sensor_msgs::Image>& message) { image_.publish(message); }

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
  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    const Clock::time_point now = Clock::now();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      results_.push_back({now, message->processing_time.toSec()});
    }
    changed_.notify_all();
  }

  std::string encoding_;
  ros::NodeHandle handle_;
  nodelet::Loader loader_;
  std::vector<sensor_msgs::Image> images_;
  std::size_t sent_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Result> results_;
  ros::Publisher image_;
  ros::Subscriber lines_;
};

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// One image at a time: from publishing to the lines' arrival, less what the method took.
void measureLatency(Stream* stream, const char* name) {
  std::vector<double> added;
  std::vector<double> processing;
  for (int i = 0; i < kFrames; ++i) {
    const auto message = stream->makeImage();
    const auto begin = Clock::now();
    stream->publish(message);
    stream->waitFor(1);
    const Result result = stream->takeResults().front();
    const double latency = std::chrono::duration<double>(result.when - begin).count();
    processing.push_back(result.processing * kMilliseconds);
    added.push_back(latency * kMilliseconds - processing.back());
  }
  std::printf(
      "%-6s latency: the method %.3f ms (median); the shell adds %.3f ms (median), "
      "%.3f ms (95 %%)\n",
      name, percentile(processing, 0.5), percentile(added, 0.5), percentile(added, 0.95));
}

/// Images without pause, at most 8 ahead, against calling the method on the same frames.
void measureThroughput(Stream* stream, const std::string& detector_name, const char* name) {
  constexpr std::size_t kAhead = 8;
  const auto begin = Clock::now();
  for (std::size_t i = 0; i < kFrames; ++i) {
    stream->publish(stream->makeImage());
    if (i >= kAhead) {
      stream->waitFor(i - kAhead);
    }
  }
  stream->waitFor(kFrames);
  const double online = secondsSince(begin);
  stream->takeResults();

  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(detector_name);
  detector->configure(YAML::Node());
  const auto plain_begin = Clock::now();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = ros_shell::toFrame(stream->makeImage());
    detector->detect(frame);
  }
  const double plain = secondsSince(plain_begin);
  std::printf(
      "%-6s throughput: %.1f images/s through the nodelet, %.1f images/s by plain calls "
      "(%.3f ms a frame more)\n",
      name, kFrames / online, kFrames / plain, (online - plain) / kFrames * kMilliseconds);
}

int run(const std::string& detector) {
  std::printf("detector %s, %d images of 640x480\n", detector.c_str(), kFrames);
  for (const std::string& encoding :
       {sensor_msgs::image_encodings::MONO8, sensor_msgs::image_encodings::BGR8}) {
    Stream stream(detector, encoding);
    measureLatency(&stream, encoding.c_str());
    measureThroughput(&stream, detector, encoding.c_str());
  }
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
    return evolin::run(argc > 1 ? argv[1] : "hough_p");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shell_benchmark: %s\n", error.what());
    return 1;
  }
}
