// A process that hosts our nodelets as a manager does, for tests that run under sanitizers: 'host
// cycle N' loads and unloads all of them N times in a stream; 'host stream FOLDER' evaluates one
// until it is interrupted; 'host address ENCODING' sees whether an image reaches a plug-in
// uncopied; 'host start' whether a nodelet that starts slowly misses anything.
#include <cv_bridge/cv_bridge.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <future>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "conversions.h"
#include "evolin_ros/LineArray.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "test/ros/foreign_lines.h"
#include "test/ros/slow_start.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

ros::Time timeOf(std::size_t frame) {
  return ros::Time(1000) + ros::Duration(0.01 * static_cast<double>(frame));
}

/// Two lines that a front-end of PL-VINS's make would follow.
sensor_msgs::PointCloud lineCloud(const std_msgs::Header& header) {
  sensor_msgs::PointCloud cloud;
  cloud.header = header;
  cloud.channels.resize(3);
  for (const float row : {-0.1F, 0.1F}) {
    geometry_msgs::Point32 start;
    start.x = -0.2F;
    start.y = row;
    start.z = 1;
    cloud.points.push_back(start);
    cloud.channels[0].values.push_back(row > 0 ? 1 : 2);
    cloud.channels[1].values.push_back(0.2F);
    cloud.channels[2].values.push_back(row);
  }
  return cloud;
}

/// One line before the camera.
visualization_msgs::Marker lineMarker(const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.pose.orientation.w = 1;
  marker.points.resize(2);
  marker.points[0].x = -0.5;
  marker.points[0].z = marker.points[1].z = 2;
  marker.points[1].x = 0.5;
  return marker;
}

/// Everything that our nodelets take, at 100 frames a second of ever later stamps.
class Camera {
 public:
  Camera()
      : image_(handle_.advertise<sensor_msgs::Image>("image", 0)),
        camera_info_(handle_.advertise<sensor_msgs::CameraInfo>("camera_info", 0)),
        truth_(handle_.advertise<evolin_ros::LineArray>("ground_truth/lines", 0)),
        depth_(handle_.advertise<sensor_msgs::Image>("depth", 0)),
        cloud_(handle_.advertise<sensor_msgs::PointCloud>("linefeature", 0)),
        marker_(handle_.advertise<visualization_msgs::Marker>("marker", 0)),
        foreign_lines_(&handle_),
        thread_([this] { run(); }) {}
  ~Camera() {
    stop_ = true;
    thread_.join();
  }
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

 private:
  void run() {
    const std::vector<SequenceFrame> drawn = drawSequence();
    auto next = std::chrono::steady_clock::now();
    for (std::size_t i = 0; !stop_ && ros::ok(); ++i) {
      const SequenceFrame& frame = drawn[i % drawn.size()];
      std_msgs::Header header;
      header.stamp = timeOf(i);
      header.frame_id = "camera";
      camera_info_.publish(ros_shell::toMessage(*frame.frame.camera, header));
      image_.publish(
          cv_bridge::CvImage(header, sensor_msgs::image_encodings::BGR8, frame.frame.image)
              .toImageMsg());
      LineSet set;
      set.source = "ground_truth";
      set.width = frame.frame.image.cols;
      set.height = frame.frame.image.rows;
      set.lines = *frame.ground_truth;
      const auto truth = boost::make_shared<evolin_ros::LineArray>(ros_shell::toMessage(set));
      truth->header = header;
      truth_.publish(truth);
      depth_.publish(cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_32FC1,
                                        cv::Mat(frame.frame.image.size(), CV_32FC1, cv::Scalar(2)))
                         .toImageMsg());
      cloud_.publish(boost::make_shared<sensor_msgs::PointCloud>(lineCloud(header)));
      marker_.publish(boost::make_shared<visualization_msgs::Marker>(lineMarker(header)));
      foreign_lines_.publish(header);
      next += std::chrono::milliseconds(10);
      std::this_thread::sleep_until(next);
    }
  }

  ros::NodeHandle handle_;
  ros::Publisher image_;
  ros::Publisher camera_info_;
  ros::Publisher truth_;
  ros::Publisher depth_;
  ros::Publisher cloud_;
  ros::Publisher marker_;
  ForeignLines foreign_lines_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void load(nodelet::Loader* loader, const std::string& name, const std::string& type,
          const nodelet::M_string& remappings = {}) {
  if (!loader->load("/" + name, "evolin_ros/" + type, remappings, {})) {
    throw std::runtime_error(name + " does not load");
  }
}

struct Nodelet {
  std::string name;
  std::string type;
  nodelet::M_string remappings;
};

/// What evaluates a stream.
std::vector<Nodelet> chain() {
  return {{"evaluator", "Evaluator", {}},
          {"detector", "LineDetector", {}},
          {"associator", "LineAssociator", {{"/lines", "/ground_truth/lines"}}}};
}

std::vector<Nodelet> everyNodelet() {
  std::vector<Nodelet> nodelets = chain();
  // No two on one topic: lines of several sources are an error of their own.
  nodelets.push_back({"viewer", "LineViewer", {}});
  nodelets.push_back({"viewer_3d", "Lines3d", {}});
  nodelets.push_back({"recorded", "GroundTruth", {{"/ground_truth/lines", "/recorded/lines"}}});
  nodelets.push_back({"cloud_adapter",
                      "PointCloudLines",
                      {{"/lines", "/cloud/lines"}, {"/matches", "/cloud/matches"}}});
  nodelets.push_back({"marker_adapter", "MarkerLines", {{"/lines", "/marker/lines"}}});
  if (kHasOpencvApps) {
    nodelets.push_back(
        {"opencv_apps_adapter", "OpencvAppsLines", {{"/lines", "/opencv_apps/lines"}}});
  }
  return nodelets;
}

void loadAll(nodelet::Loader* loader, const std::vector<Nodelet>& nodelets) {
  for (const Nodelet& nodelet : nodelets) {
    load(loader, nodelet.name, nodelet.type, nodelet.remappings);
  }
}

void setParameters(const std::string& folder) {
  ros::param::set("/evaluator/output_dir", folder);
  ros::param::set("/evaluator/save_period", 0.1);
  ros::param::set("/evaluator/diagnostic_period", 0.05);
  ros::param::set("/detector/detector", "hough_p");
  for (const char* method : {"detector", "associator"}) {
    ros::param::set(std::string("/") + method + "/lazy", false);
    ros::param::set(std::string("/") + method + "/realtime", true);
  }
  for (const Nodelet& nodelet : everyNodelet()) {
    ros::param::set("/" + nodelet.name + "/diagnostic_period", 0.05);
  }
}

/// A folder that GroundTruth takes, with the first drawn frames' annotations.
void writeAnnotations(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<StampedFile> stamps;
  for (const SequenceFrame& frame : drawSequence()) {
    const std::string name = frame.frame.name + ".csv";
    writeLinesCsv(folder / name, *frame.ground_truth);
    stamps.push_back({ros_shell::fromRos(timeOf(stamps.size())), name});
  }
  writeStampsFile(folder / "stamps.txt", stamps);
  ros::param::set("/recorded/folder", folder.string());
}

/// Somebody who looks: without him a viewer does nothing.
template <class Message>
ros::Subscriber lookAt(ros::NodeHandle* handle, const std::string& topic) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> look = [](const auto&) {};
  return handle->subscribe<Message>(topic, 1, look);
}

/// The order of unloading changes from round to round.
int cycle(int rounds, const std::string& folder) {
  setParameters(folder);
  writeAnnotations(std::filesystem::path(folder) / "annotations");
  nodelet::Loader loader(false);
  const Camera camera;
  ros::NodeHandle handle;
  const std::vector<ros::Subscriber> lookers = {
      lookAt<sensor_msgs::Image>(&handle, "overlay"),
      lookAt<visualization_msgs::MarkerArray>(&handle, "markers"),
      lookAt<visualization_msgs::MarkerArray>(&handle, "lines_3d"),
      lookAt<sensor_msgs::Image>(&handle, "lines_image")};
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::vector<Nodelet> nodelets = everyNodelet();
  std::mt19937 random(7);
  for (int i = 0; i < rounds; ++i) {
    loadAll(&loader, nodelets);
    // Between nothing and a few frames.
    std::this_thread::sleep_for(std::chrono::milliseconds(i * 37 % 90));
    std::shuffle(nodelets.begin(), nodelets.end(), random);
    for (const Nodelet& nodelet : nodelets) {
      if (!loader.unload("/" + nodelet.name)) {
        throw std::runtime_error(nodelet.name + " does not unload");
      }
    }
  }
  return 0;
}

int stream(const std::string& folder) {
  setParameters(folder);
  nodelet::Loader loader(false);
  loadAll(&loader, chain());
  const Camera camera;
  ros::spin();
  return 0;
}

/// 0 when the plug-in got the very pixels of the message that was published in this process.
int address(const std::string& encoding) {
  ros::param::set("/detector/detector", "test_address");
  ros::param::set("/detector/lazy", false);
  nodelet::Loader loader(false);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ros::NodeHandle handle;
  std::promise<double> got;
  const ros::Subscriber lines = handle.subscribe<evolin_ros::LineArray>(
      "lines", 1, [&got](const evolin_ros::LineArrayConstPtr& message) {
        got.set_value(message->lines.at(0).x1);
      });
  ros::Publisher image = handle.advertise<sensor_msgs::Image>("image", 1);
  load(&loader, "detector", "LineDetector");
  const int type = encoding == sensor_msgs::image_encodings::MONO8 ? CV_8UC1 : CV_8UC3;
  std_msgs::Header header;
  header.stamp = ros::Time(1000);
  const sensor_msgs::ImagePtr message =
      cv_bridge::CvImage(header, encoding, cv::Mat(48, 64, type, cv::Scalar::all(90))).toImageMsg();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (image.getNumSubscribers() == 0 || lines.getNumPublishers() == 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("the nodelet does not connect");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  image.publish(message);
  std::future<double> result = got.get_future();
  if (result.wait_until(deadline) != std::future_status::ready) {
    throw std::runtime_error("the nodelet sends no lines");
  }
  const auto expected = static_cast<double>(reinterpret_cast<std::uintptr_t>(message->data.data()));
  return result.get() == expected ? 0 : 4;
}

}  // namespace
}  // namespace evolin::test

int main(int argc, char** argv) {
  ros::init(argc, argv, "nodelet_host");
  const std::string verb = argc > 1 ? argv[1] : "";
  try {
    if (verb == "cycle" && argc > 3) {
      return evolin::test::cycle(std::stoi(argv[2]), argv[3]);
    }
    if (verb == "address" && argc > 2) {
      return evolin::test::address(argv[2]);
    }
    if (verb == "start") {
      return evolin::test::slowStart();
    }
    if (verb == "stream" && argc > 2) {
      return evolin::test::stream(argv[2]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nodelet_host: %s\n", error.what());
    return 3;
  }
  std::fprintf(
      stderr,
      "usage: nodelet_host cycle ROUNDS FOLDER | stream FOLDER | address ENCODING | start\n");
  return 2;
}
