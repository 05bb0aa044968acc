// The nodelet evolin_ros/GroundTruth: plays a folder of annotated (or recorded) lines beside a
// stream of images.
#include <image_transport/image_transport.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <string>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/dataset/annotation_folder.h"
#include "health.h"
#include "node_parameters.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class GroundTruthNodelet : public SafeNodelet {
 public:
  GroundTruthNodelet() = default;
  ~GroundTruthNodelet() override {
    if (health_) {
      health_->stop();
    }
    unloadLast();
  }
  GroundTruthNodelet(const GroundTruthNodelet&) = delete;
  GroundTruthNodelet& operator=(const GroundTruthNodelet&) = delete;
  GroundTruthNodelet(GroundTruthNodelet&&) = delete;
  GroundTruthNodelet& operator=(GroundTruthNodelet&&) = delete;

 private:
  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    readOptions();
    if (!folder_->hasStamps()) {
      throw Error(
          folder_->folder().string() +
          ": which file belongs to which image is unknown: there is no stamps.txt in it and "
          "~stamps "
          "is not set. 'evolin bag' writes one beside the bag (NAME.stamps.txt); by hand it has a "
          "line 'stamp file' for every file, as in TUM's lists, for example "
          "'1305031453.359684 0000.csv'");
    }
    NODELET_INFO("%zu files of %s as '%s', from %s s to %s s", folder_->size(),
                 folder_->folder().c_str(), source_.c_str(),
                 formatStamp(*folder_->firstStamp()).c_str(),
                 formatStamp(*folder_->lastStamp()).c_str());
    if (folder_->unlisted() > 0) {
      NODELET_WARN("%zu files of %s have no entry in the stamps file and will never be played",
                   folder_->unlisted(), folder_->folder().c_str());
    }
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), warn_after_);
    watchdog_->expect(handle.resolveName(topics::kImage), "sensor_msgs/Image",
                      "Remap 'image' to the camera's topic.");
    health_->expect(handle.resolveName(topics::kImage));
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
    lines_ = handle.advertise<evolin_ros::LineArray>(topics::kGroundTruthLines, kResultQueue);
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    image_ = image_transport_->subscribe(
        topics::kImage, kResultQueue, &GroundTruthNodelet::onImage, this,
        image_transport::TransportHints(transport_, ros::TransportHints(), getPrivateNodeHandle()));
  }

  void readOptions() {
    std::string folder;
    std::string stamps;
    bool same_rows = false;
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    reader.read("folder", &folder);
    reader.read("stamps", &stamps);
    reader.read("source", &source_);
    reader.read("same_rows", &same_rows);
    reader.read("image_transport", &transport_);
    reader.read("warn_after", &warn_after_, 0, 1e6);
    health_ = std::make_unique<Health>(getName(), readHealthLimits(&reader, getName()));
    reader.finish();
    if (folder.empty()) {
      throw ConfigError(getName(), "folder", "not set; expected a folder of line files");
    }
    folder_ = std::make_unique<AnnotationFolder>(expandPath(folder), expandPath(stamps), same_rows);
  }

  void onImage(const sensor_msgs::ImageConstPtr& message) {
    const ros::WallTime begin = ros::WallTime::now();
    watchdog_->heard(getNodeHandle().resolveName(topics::kImage));
    health_->heard(getNodeHandle().resolveName(topics::kImage));
    std::optional<LineSegments> lines = folder_->at(fromRos(message->header.stamp));
    if (!lines) {
      health_->dropped("without an entry");
      if (warnings_.due()) {
        NODELET_WARN(
            "no entry within 0.001 s of the image at %.6f (stamps from %s to %s): "
            "this frame has no lines of '%s'",
            message->header.stamp.toSec(), formatStamp(*folder_->firstStamp()).c_str(),
            formatStamp(*folder_->lastStamp()).c_str(), source_.c_str());
      }
      return;
    }
    LineSet set;
    set.lines = std::move(*lines);
    set.source = source_;
    set.width = static_cast<int>(message->width);
    set.height = static_cast<int>(message->height);
    set.scored = folder_->hasScores();
    const auto array = boost::make_shared<evolin_ros::LineArray>(toMessage(set));
    array->header = message->header;
    lines_.publish(array);
    const double seconds = (ros::WallTime::now() - begin).toSec();
    health_->finished(seconds, seconds);
  }

  std::unique_ptr<AnnotationFolder> folder_;
  std::string source_ = "ground_truth";
  std::string transport_ = "raw";
  double warn_after_ = 3;
  WallThrottle warnings_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Subscriber image_;
  ros::Publisher lines_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::GroundTruthNodelet, nodelet::Nodelet)
