// A detector that tells where in memory the image is that it got, to show that nobody has copied
// it.
#include <cstdint>
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin::test {

/// One line whose x1 is the address of the first pixel, below 2^53 on every machine of today.
class AddressDetector : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override {
    ParameterReader(parameters, "detector test_address").finish();
  }

  LineSegments detect(const Frame& frame) override {
    LineSegment line;
    line.x1 = static_cast<double>(reinterpret_cast<std::uintptr_t>(frame.image.data));
    return {line};
  }
};

}  // namespace evolin::test

PLUGINLIB_EXPORT_CLASS(evolin::test::AddressDetector, evolin::LineDetector)
