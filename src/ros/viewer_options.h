// The parameters of the nodelet evolin_ros/LineViewer.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "evolin_ros/drawing/evaluation_view.h"
#include "health.h"
#include "view_frame.h"

namespace evolin::ros_shell {

struct ViewerOptions {
  ViewOptions view;
  ViewFrameOptions frame;
  double plane_distance = 1;  ///< metres from the camera to the plane that markers lie on
  int queue_size = 30;        ///< messages of each kind that may wait for the others
  int patience = 3;           ///< later frames until one is shown without what it lacks
  std::string image_transport = "raw";
  double warn_after = 3;  ///< s, 0: never
  HealthLimits health;
};

/// Throws ConfigError naming the parameter, its value and what is accepted. `owner` stands at the
/// head of messages.
ViewerOptions readViewerOptions(const YAML::Node& parameters, const std::string& owner);

}  // namespace evolin::ros_shell
