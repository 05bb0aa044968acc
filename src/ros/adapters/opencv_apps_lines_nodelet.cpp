// The nodelet evolin_ros/OpencvAppsLines: lines of opencv_apps' nodelets in and out.
#include <opencv_apps/LineArrayStamped.h>
#include <pluginlib/class_list_macros.hpp>

#include <string>

#include "camera_adapter.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

class OpencvAppsLinesNodelet : public CameraAdapter<opencv_apps::LineArrayStamped> {
 public:
  OpencvAppsLinesNodelet() = default;
  ~OpencvAppsLinesNodelet() override {
    lines_in_.shutdown();
    end();
  }
  OpencvAppsLinesNodelet(const OpencvAppsLinesNodelet&) = delete;
  OpencvAppsLinesNodelet& operator=(const OpencvAppsLinesNodelet&) = delete;
  OpencvAppsLinesNodelet(OpencvAppsLinesNodelet&&) = delete;
  OpencvAppsLinesNodelet& operator=(OpencvAppsLinesNodelet&&) = delete;

 private:
  void start() override {
    std::string direction = "from";
    source_ = "opencv_apps";
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    readCommon(&reader);
    reader.read("direction", &direction, {"from", "to"});
    reader.finish();
    if (direction == "from") {
      begin(topics::kOpencvAppsLines, AdapterPixels::kSizeOnly,
            "Remap 'opencv_apps_lines' to the lines of, for example, hough_lines.");
      return;
    }
    ros::NodeHandle& handle = getNodeHandle();
    foreign_lines_ =
        handle.advertise<opencv_apps::LineArrayStamped>(topics::kOpencvAppsLines, kResultQueue);
    startHealth(topics::kLines, ros::message_traits::datatype<evolin_ros::LineArray>(),
                "Remap 'lines' to the lines of a detector.");
    lines_in_ =
        handle.subscribe(topics::kLines, kResultQueue, &OpencvAppsLinesNodelet::onLines, this);
    NODELET_INFO("lines of %s for opencv_apps", handle.resolveName(topics::kLines).c_str());
  }

  void convert(const opencv_apps::LineArrayStamped& message, const AdapterView& view) override {
    LineSet set;
    for (const opencv_apps::Line& line : message.lines) {
      LineSegment segment;
      segment.x1 = line.pt1.x;
      segment.y1 = line.pt1.y;
      segment.x2 = line.pt2.x;
      segment.y2 = line.pt2.y;
      set.lines.push_back(segment);
    }
    AdapterView framed = view;
    if (framed.frame_id.empty()) {
      framed.frame_id = withoutLeadingSlash(message.header.frame_id);
    }
    publish(&set, message.header.stamp, framed);
  }

  /// Scores, ids, source and size have no place there.
  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    const ros::WallTime begin = ros::WallTime::now();
    heard();
    const auto foreign = boost::make_shared<opencv_apps::LineArrayStamped>();
    foreign->header = message->header;
    for (const evolin_ros::Line& line : message->lines) {
      opencv_apps::Line copy;
      copy.pt1.x = line.x1;
      copy.pt1.y = line.y1;
      copy.pt2.x = line.x2;
      copy.pt2.y = line.y2;
      foreign->lines.push_back(copy);
    }
    foreign_lines_.publish(foreign);
    finished(begin);
  }

  ros::Publisher foreign_lines_;
  ros::Subscriber lines_in_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::OpencvAppsLinesNodelet, nodelet::Nodelet)
