// The nodelet evolin_ros/MarkerLines: a marker's lines in the camera's frame in, what the camera's
// image shows of them out.
#include <visualization_msgs/Marker.h>
#include <pluginlib/class_list_macros.hpp>

#include <optional>
#include <string>

#include "camera_adapter.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "marker_segments.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

class MarkerLinesNodelet : public CameraAdapter<visualization_msgs::Marker> {
 public:
  MarkerLinesNodelet() = default;
  ~MarkerLinesNodelet() override { end(); }
  MarkerLinesNodelet(const MarkerLinesNodelet&) = delete;
  MarkerLinesNodelet& operator=(const MarkerLinesNodelet&) = delete;
  MarkerLinesNodelet(MarkerLinesNodelet&&) = delete;
  MarkerLinesNodelet& operator=(MarkerLinesNodelet&&) = delete;

 private:
  void start() override {
    std::string pixels = "distorted";
    source_ = "markers";
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    readCommon(&reader);
    reader.read("pixels", &pixels, {"distorted", "rectified"});
    reader.read("namespace", &namespace_);
    reader.read("near", &near_, 1e-6, 1000);
    reader.finish();
    begin(topics::kMarker, parsePixels(pixels),
          "Remap 'marker' to a topic of line lists in the camera's frame.");
  }

  void convert(const visualization_msgs::Marker& message, const AdapterView& view) override {
    if (message.action != visualization_msgs::Marker::ADD) {
      return;  // nothing is shown, so nothing is to be taken away
    }
    if (!namespace_.empty() && message.ns != namespace_) {
      return;
    }
    const std::string frame = withoutLeadingSlash(message.header.frame_id);
    if (!view.frame_id.empty() && frame != view.frame_id) {
      throw Error("its frame is " + quote(frame) + ", expected the camera's, " +
                  quote(view.frame_id) + " (~frame_id names another)");
    }
    LineSet set;
    for (const Segment3d& segment : segmentsOf(message)) {
      if (const std::optional<LineSegment> line = view.view.project(segment, near_)) {
        set.lines.push_back(*line);
      }
    }
    publish(&set, message.header.stamp, view);
  }

  std::string namespace_;
  double near_ = 0.05;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::MarkerLinesNodelet, nodelet::Nodelet)
