// The nodelet evolin_ros/PointCloudLines: the tracked lines of PL-VIO, PL-VINS and their kin in;
// lines in pixels, and matches by track id, out.
#include <evolin_ros/LineMatchArray.h>
#include <sensor_msgs/PointCloud.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <string>
#include <utility>

#include "camera_adapter.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/id_matches.h"
#include "line_cloud.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

class PointCloudLinesNodelet : public CameraAdapter<sensor_msgs::PointCloud> {
 public:
  PointCloudLinesNodelet() = default;
  ~PointCloudLinesNodelet() override { end(); }
  PointCloudLinesNodelet(const PointCloudLinesNodelet&) = delete;
  PointCloudLinesNodelet& operator=(const PointCloudLinesNodelet&) = delete;
  PointCloudLinesNodelet(PointCloudLinesNodelet&&) = delete;
  PointCloudLinesNodelet& operator=(PointCloudLinesNodelet&&) = delete;

 private:
  void start() override {
    std::string pixels = "distorted";
    int frame_step = 1;
    source_ = "pl_vins";
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    readCommon(&reader);
    reader.read("pixels", &pixels, {"distorted", "rectified"});
    reader.read("number_of_cameras", &format_.number_of_cameras, 1, 1000);
    reader.read("camera_index", &format_.camera_index, 0, 999);
    reader.read("frame_step", &frame_step, 1, 100000);
    reader.finish();
    try {
      validate(format_);
    } catch (const Error& error) {
      throw ConfigError(getName(), "camera_index", error.what());
    }
    matcher_ = std::make_unique<IdMatcher>(frame_step, source_);
    matches_ =
        getNodeHandle().advertise<evolin_ros::LineMatchArray>(topics::kMatches, kResultQueue);
    begin(topics::kLineCloud, parsePixels(pixels),
          "Remap 'linefeature' to the front-end's cloud of lines, for example "
          "/linefeature_tracker/linefeature.");
  }

  void convert(const sensor_msgs::PointCloud& message, const AdapterView& view) override {
    LineCloud cloud = readLineCloud(message, format_);
    LineSet set;
    set.lines = toPixels(view.view, &cloud);
    const std::string at = "cloud at " + formatStamp(fromRos(message.header.stamp)) + ": ";
    if (cloud.unusable > 0) {
      left_out_ += cloud.unusable;
      warn(at + std::to_string(cloud.unusable) + " lines left out (" + std::to_string(left_out_) +
           " so far): " + cloud.first_problem);
    }
    if (cloud.inexact_ids && !std::exchange(inexact_told_, true)) {
      warn(at +
           "ids times cameras exceed 16777216, beyond which single precision, in which they "
           "come, does not tell neighbours apart: tracks may run into each other");
    }
    publish(&set, message.header.stamp, view);
    const IdMatcher::Result result = matcher_->add(set);
    if (result.jumped_back) {
      NODELET_INFO("time jumped back to %.6f: earlier lines are forgotten",
                   message.header.stamp.toSec());
    }
    if (result.repeated > 0) {
      warn(at + std::to_string(result.repeated) +
           " lines repeat an id; the first of an id alone is matched");
    }
    if (result.matches) {
      matches_.publish(boost::make_shared<evolin_ros::LineMatchArray>(toMessage(*result.matches)));
    }
  }

  LineCloudFormat format_;
  std::unique_ptr<IdMatcher> matcher_;
  std::size_t left_out_ = 0;
  bool inexact_told_ = false;
  ros::Publisher matches_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::PointCloudLinesNodelet, nodelet::Nodelet)
