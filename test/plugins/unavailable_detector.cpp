// A detector that no build can run, to show what becomes of those who ask for it.
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin::test {

class UnavailableDetector : public LineDetector {
 public:
  std::string whyUnavailable() const override { return "needs what no build has"; }

  void configure(const YAML::Node& /*parameters*/) override {
    requireAvailable("detector test_unavailable", whyUnavailable());
  }

  LineSegments detect(const Frame& /*frame*/) override { return {}; }
};

}  // namespace evolin::test

PLUGINLIB_EXPORT_CLASS(evolin::test::UnavailableDetector, evolin::LineDetector)
