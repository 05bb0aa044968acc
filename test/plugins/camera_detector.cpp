// A detector that asks for the camera and for nothing else.
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin::test {

/// One line, through the principal point.
class CameraDetector : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override {
    ParameterReader(parameters, "detector test_camera").finish();
  }

  Needs needs() const override {
    Needs needs;
    needs.camera = true;
    return needs;
  }

  LineSegments detect(const Frame& frame) override {
    if (!frame.camera) {
      throw Error("detector test_camera: the frame has no camera");
    }
    LineSegment line;
    line.x1 = frame.camera->cx - 10;
    line.x2 = frame.camera->cx + 10;
    line.y1 = frame.camera->cy - 1;
    line.y2 = frame.camera->cy + 1;
    return {line};
  }
};

}  // namespace evolin::test

PLUGINLIB_EXPORT_CLASS(evolin::test::CameraDetector, evolin::LineDetector)
