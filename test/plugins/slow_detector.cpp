// A detector that takes its time, to show what waits for it.
#include <chrono>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin::test {

/// Lines of hough_p with its defaults, `seconds` (0.3) later.
class SlowDetector : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override {
    ParameterReader reader(parameters, "detector test_slow");
    reader.read("seconds", &seconds_, 0, 60);
    reader.finish();
    detector_.configure(YAML::Node());
  }

  LineSegments detect(const Frame& frame) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds_));
    return detector_.detect(frame);
  }

 private:
  HoughP detector_;
  double seconds_ = 0.3;
};

}  // namespace evolin::test

PLUGINLIB_EXPORT_CLASS(evolin::test::SlowDetector, evolin::LineDetector)
