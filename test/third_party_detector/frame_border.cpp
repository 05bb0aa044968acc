// A detector plug-in of another package: finds the image's own border, a given margin inside.
#include <evolin_ros/base/parameters.h>
#include <evolin_ros/detection/line_detector.h>

#include <pluginlib/class_list_macros.hpp>

namespace third_party {

class FrameBorder : public evolin::LineDetector {
 public:
  void configure(const YAML::Node& parameters) override {
    evolin::ParameterReader reader(parameters, "detector frame_border");
    reader.read("margin", &margin_, 0.0, 1000.0);
    reader.finish();
  }

  evolin::LineSegments detect(const evolin::Frame& frame) override {
    const double low = margin_;
    const double right = frame.image.cols - 1 - margin_;
    const double bottom = frame.image.rows - 1 - margin_;
    const auto side = [](double x1, double y1, double x2, double y2) {
      return evolin::LineSegment{x1, y1, x2, y2, evolin::kNoScore, evolin::kNoId};
    };
    return {side(low, low, right, low), side(right, low, right, bottom),
            side(right, bottom, low, bottom), side(low, bottom, low, low)};
  }

 private:
  double margin_ = 0;  ///< pixels
};

}  // namespace third_party

PLUGINLIB_EXPORT_CLASS(third_party::FrameBorder, evolin::LineDetector)
