// The nodelet evolin_ros/Lines3d: lines, ground truth and depth in; lines in space out, coloured by
// what became of them.
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>
#include <pluginlib/class_list_macros.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/evaluation/stamped_depth.h"
#include "evolin_ros/geometry/lens_distortion.h"
#include "evolin_ros/geometry/segment_fit.h"
#include "evolin_ros/metrics/line_verdicts.h"
#include "health.h"
#include "node_parameters.h"
#include "pose_source.h"
#include "safe_nodelet.h"
#include "spatial_markers.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "view_markers.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

/// All callbacks share the single-threaded queue, but for those about listeners.
class Lines3dNodelet : public SafeNodelet {
 private:
  struct Options {
    std::string fixed_frame;
    bool with_ground_truth = true;
    VectorizedSetting setting{LineDistance::kStructural, 5};
    Protocol protocol = Protocol::kEvolin;
    SegmentFitOptions fit;
    double depth_factor = 1000;
    double max_time_difference = 0.02;
    double width = 0.01;
    int queue_size = kImageQueue;
    bool lazy = true;
    double warn_after = 3;
    HealthLimits health;
  };

  /// The parts of a frame that have come.
  struct Entry {
    std::optional<LineSet> lines;
    ros::WallTime lines_came;
    std::optional<LineSet> ground_truth;
    std::optional<Pose> pose;
  };

  void start() override {
    readOptions();
    if (!options_.fixed_frame.empty()) {
      tf_ = std::make_unique<TfPoses>(options_.fixed_frame);
    }
    depth_.emplace(fromSeconds(options_.max_time_difference),
                   static_cast<std::size_t>(options_.queue_size));
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);
    health_ = std::make_unique<Health>(getName(), options_.health);
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
    NODELET_INFO("waiting for %s and %s%s", name(topics::kLines).c_str(),
                 name(topics::kDepth).c_str(),
                 options_.lazy ? " (subscribed once somebody listens to the markers)" : "");
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    markers_ = getNodeHandle().advertise<visualization_msgs::MarkerArray>(
        topics::kLines3d, kResultQueue, on_listener, on_listener);
    // Of listeners that the topic has already older releases of roscpp do not tell.
    if (!options_.lazy || markers_.getNumSubscribers() > 0) {
      subscribe();
    }
  }

  void readOptions() {
    std::string distance = toString(options_.setting.distance);
    std::string protocol = toString(options_.protocol);
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    reader.read("fixed_frame", &options_.fixed_frame);
    reader.read("with_ground_truth", &options_.with_ground_truth);
    reader.read("distance", &distance, {"orthogonal", "structural"});
    reader.read("threshold", &options_.setting.threshold, 1e-6, 1e9);
    reader.read("protocol", &protocol, {"evolin", "paper"});
    reader.read("reach", &options_.fit.reach, 0, 50);
    reader.read("tolerance", &options_.fit.tolerance, 1e-6, 0.5);
    reader.read("min_support", &options_.fit.min_support, 0.01, 1);
    reader.read("depth_factor", &options_.depth_factor, 1e-6, 1e9);
    reader.read("max_time_difference", &options_.max_time_difference, 0, 10);
    reader.read("width", &options_.width, 1e-6, 100);
    reader.read("queue_size", &options_.queue_size, 1, 100000);
    reader.read("lazy", &options_.lazy);
    reader.read("warn_after", &options_.warn_after, 0, 1e6);
    options_.health = readHealthLimits(&reader, getName());
    reader.finish();
    options_.setting.distance =
        distance == "orthogonal" ? LineDistance::kOrthogonal : LineDistance::kStructural;
    options_.protocol = parseProtocol(protocol);
  }

  std::string name(const std::string& topic) { return getNodeHandle().resolveName(topic); }

  /// Called at every change of listeners, from any thread.
  void connect() {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    if (!options_.lazy) {
      return;
    }
    const bool wanted = markers_.getNumSubscribers() > 0;
    if (wanted && subscribers_.empty()) {
      subscribe();
    } else if (!wanted && !subscribers_.empty()) {
      subscribers_.clear();
      for (const char* topic :
           {topics::kLines, topics::kDepth, topics::kCameraInfo, topics::kGroundTruthLines}) {
        watchdog_->forget(name(topic));
      }
      health_->forget(name(topics::kLines));
    }
  }

  void subscribe() {
    ros::NodeHandle& handle = getNodeHandle();
    health_->expect(name(topics::kLines));
    watchdog_->expect(name(topics::kLines), "evolin_ros/LineArray", "Remap 'lines'.");
    watchdog_->expect(name(topics::kDepth), "sensor_msgs/Image", "Remap 'depth'.");
    watchdog_->expect(name(topics::kCameraInfo), "sensor_msgs/CameraInfo", "Remap 'camera_info'.");
    const auto queue = static_cast<std::uint32_t>(options_.queue_size);
    using Nodelet = Lines3dNodelet;
    subscribers_ = {
        handle.subscribe(topics::kLines, kResultQueue, &Nodelet::onLines, this),
        handle.subscribe(topics::kDepth, queue, &Nodelet::onDepth, this),
        handle.subscribe(topics::kCameraInfo, kResultQueue, &Nodelet::onCameraInfo, this)};
    if (options_.with_ground_truth) {
      watchdog_->expect(name(topics::kGroundTruthLines), "evolin_ros/LineArray",
                        "Play it, or set ~with_ground_truth to false.");
      subscribers_.push_back(
          handle.subscribe(topics::kGroundTruthLines, kResultQueue, &Nodelet::onGroundTruth, this));
    }
    if (tf_) {
      subscribers_.push_back(handle.subscribe<tf2_msgs::TFMessage>(
          topics::kTfStatic, kResultQueue,
          [this](const tf2_msgs::TFMessageConstPtr& message) { onTf(*message, true); }));
      subscribers_.push_back(handle.subscribe<tf2_msgs::TFMessage>(
          topics::kTf, kResultQueue,
          [this](const tf2_msgs::TFMessageConstPtr& message) { onTf(*message, false); }));
    }
  }

  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    watchdog_->heard(name(topics::kLines));
    health_->heard(name(topics::kLines));
    const LineSet set = fromMessage(*message);
    if (newest_ && set.stamp < *newest_) {
      NODELET_INFO("time jumped back to %.6f: markers and waiting frames are taken away",
                   message->header.stamp.toSec());
      forget(message->header);
    }
    newest_ = set.stamp;
    Entry& entry = entries_[set.stamp];
    entry.lines = set;
    entry.lines_came = ros::WallTime::now();
    if (tf_) {
      takePoses([&] { return tf_->ask(set.stamp, set.frame_id); });
    }
    drawComplete();
  }

  void forget(std_msgs::Header header) {
    if (tf_) {
      header.frame_id = options_.fixed_frame;
      tf_->startPass();
    }
    markers_.publish(noMarkers(header));
    entries_.clear();
    depth_.emplace(fromSeconds(options_.max_time_difference),
                   static_cast<std::size_t>(options_.queue_size));
  }

  void onGroundTruth(const evolin_ros::LineArrayConstPtr& message) {
    watchdog_->heard(name(topics::kGroundTruthLines));
    LineSet set = fromMessage(*message);
    const Stamp stamp = set.stamp;
    entries_[stamp].ground_truth = std::move(set);
    drawComplete();
  }

  void onDepth(const sensor_msgs::ImageConstPtr& message) {
    watchdog_->heard(name(topics::kDepth));
    try {
      depth_->add(fromRos(message->header.stamp), toDepthMap(message, options_.depth_factor));
    } catch (const std::exception& error) {
      warn(name(topics::kDepth) + ": " + error.what());
      return;
    }
    drawComplete();
  }

  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
    watchdog_->heard(name(topics::kCameraInfo));
    try {
      camera_ = fromMessage(*message);
      camera_problem_.clear();
    } catch (const Error& error) {
      // Once: it comes with every image.
      if (std::exchange(camera_problem_, error.what()) != error.what()) {
        NODELET_WARN("%s: %s", name(topics::kCameraInfo).c_str(), error.what());
      }
      return;
    }
    const LensDistortion lens(*camera_);
    if (lens.isDistorted() && !std::exchange(distortion_told_, true)) {
      NODELET_WARN("%s: the lens distorts, which is not looked at here: lines bend; rectify first",
                   name(topics::kCameraInfo).c_str());
    }
  }

  void onTf(const tf2_msgs::TFMessage& message, bool is_static) {
    takePoses([&] { return tf_->add(message, is_static); });
    drawComplete();
  }

  template <class Ask>
  void takePoses(const Ask& ask) {
    try {
      for (const StampedPose& known : ask()) {
        const auto entry = entries_.find(known.stamp);
        if (entry != entries_.end()) {
          entry->second.pose = known.pose;
        }
      }
    } catch (const std::exception& error) {
      warn(error.what());
    }
  }

  void warn(const std::string& text) {
    if (warnings_.due()) {
      NODELET_WARN("%s", text.c_str());
    }
  }

  /// In order of time; what lacks a part waits until newer frames push it out.
  void drawComplete() {
    for (auto entry = entries_.begin(); entry != entries_.end();) {
      entry =
          drawWhenComplete(entry->first, entry->second) ? entries_.erase(entry) : std::next(entry);
    }
    while (entries_.size() > static_cast<std::size_t>(options_.queue_size)) {
      giveUp(entries_.begin()->first, whatIsMissing(entries_.begin()->second));
      entries_.erase(entries_.begin());
    }
  }

  void giveUp(Stamp stamp, const std::string& why) {
    ++given_up_;
    health_->dropped("given up");
    warn("frame " + formatStamp(stamp) + " given up (" + std::to_string(given_up_) +
         " so far): " + why);
  }

  std::string whatIsMissing(const Entry& entry) const {
    std::string missing;
    const auto add = [&missing](bool lacks, const std::string& what) {
      missing += !lacks ? "" : (missing.empty() ? "no " : ", no ") + what;
    };
    add(!entry.lines, "lines");
    add(options_.with_ground_truth && !entry.ground_truth, "ground truth");
    add(!camera_, "camera_info");
    add(tf_ && !entry.pose, "tf to " + options_.fixed_frame);
    return missing.empty() ? "no depth yet" : missing;
  }

  /// True when the frame is done with, one way or the other.
  bool drawWhenComplete(Stamp stamp, const Entry& entry) {
    const bool complete = entry.lines && camera_ && (!tf_ || entry.pose) &&
                          (!options_.with_ground_truth || entry.ground_truth);
    if (!complete) {
      return false;
    }
    const DepthMap* depth = nullptr;
    switch (depth_->find(stamp, false, &depth)) {
      case Lookup::kNotYet:
        return false;
      case Lookup::kNever:
        giveUp(stamp, "no depth within ~max_time_difference");
        return true;
      case Lookup::kFound:
        break;
    }
    const ros::WallTime begin = ros::WallTime::now();
    try {
      draw(entry, *depth);
      const ros::WallTime end = ros::WallTime::now();
      health_->finished((end - entry.lines_came).toSec(), (end - begin).toSec());
    } catch (const std::exception& error) {
      health_->dropped("unusable");
      warn("no markers for frame " + formatStamp(stamp) + ": " + error.what());
    }
    return true;
  }

  void draw(const Entry& entry, const DepthMap& depth) {
    const LineSet& lines = *entry.lines;
    std::vector<SegmentGroup> groups = emptyGroups();
    const auto add = [&](const LineSegment& line, std::size_t group) {
      std::optional<SegmentFit> fit = fitSegment(*camera_, line, depth, options_.fit);
      if (!fit) {
        return;
      }
      if (entry.pose) {
        for (Eigen::Vector3d* point : {&fit->segment.p1, &fit->segment.p2}) {
          *point = entry.pose->rotation * *point + entry.pose->translation;
        }
      }
      groups[group].segments.push_back(fit->segment);
    };
    constexpr std::size_t kTrue = 0;
    constexpr std::size_t kFalse = 1;
    constexpr std::size_t kMissed = 2;
    constexpr std::size_t kNotJudged = 3;
    LineVerdicts verdicts;
    if (entry.ground_truth) {
      const LineSegments& truth = entry.ground_truth->lines;
      verdicts = judgeLines(options_.setting, options_.protocol, {lines.width, lines.height},
                            lines.lines, truth, lines.scored);
      for (std::size_t row = 0; row < truth.size(); ++row) {
        if (!verdicts.found[row]) {
          add(truth[row], kMissed);
        }
      }
    }
    for (std::size_t row = 0; row < lines.lines.size(); ++row) {
      const bool judged = entry.ground_truth && verdicts.predicted[row] != LineVerdict::kDropped;
      const bool hit = judged && verdicts.predicted[row] == LineVerdict::kTruePositive;
      add(lines.lines[row], hit ? kTrue : judged ? kFalse : kNotJudged);
    }
    std_msgs::Header header;
    header.stamp = toRosTime(lines.stamp);
    header.frame_id = entry.pose ? withoutLeadingSlash(options_.fixed_frame) : lines.frame_id;
    markers_.publish(markersOf(header, groups, options_.width));
  }

  Options options_;
  std::unique_ptr<TfPoses> tf_;  ///< only where there is a fixed frame
  std::map<Stamp, Entry> entries_;
  std::optional<StampedDepth> depth_;
  std::optional<Camera> camera_;
  std::string camera_problem_;  ///< of the newest camera_info, when it cannot be used
  std::optional<Stamp> newest_;
  std::size_t given_up_ = 0;
  bool distortion_told_ = false;
  WallThrottle warnings_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  std::mutex connect_mutex_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher markers_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::Lines3dNodelet, nodelet::Nodelet)
