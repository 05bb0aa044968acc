// The detector nodelet's parameters, and what follows from them for the lines that come out.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "camera_source.h"
#include "evolin_ros/drawing/overlay.h"
#include "evolin_ros/geometry/line_selection.h"
#include "health.h"

namespace evolin::ros_shell {

struct DetectorOptions {
  std::string detector = "lsd";
  std::string config;          ///< YAML file of the plug-in's parameters
  YAML::Node parameters;       ///< those of `config` with the node's own laid over them
  std::string source;          ///< name of the lines; "": the detector's
  std::string named_detector;  ///< whose lines `source` was first the name of; "": `detector`
  std::string camera;          ///< preset or file; "": camera_info
  Rectify rectify = Rectify::kNever;
  LineSelection selection;
  LineStyle style;

  // What follows is read at the start alone.
  std::string image_transport = "raw";
  int queue_size = 0;     ///< images that may wait; 0: any number
  bool realtime = false;  ///< only the newest image waits
  bool lazy = true;
  double warn_after = 3;
  HealthLimits health;

  std::string name() const { return source.empty() ? detector : source; }

  /// What LineArray.source says: name(), and a tag that changes with every setting that changes the
  /// lines; without a tag where all are the defaults.
  std::string taggedSource() const;

  /// Whether only a restart would bring what `now` says into effect; names it, "" when nothing is.
  std::string needsRestart(const DetectorOptions& now) const;
};

/// Throws ConfigError or Error naming the parameter, its value and what is accepted. Whether the
/// plug-in accepts its own parameters is not known yet.
DetectorOptions readDetectorOptions(const YAML::Node& parameters, const std::string& owner);

}  // namespace evolin::ros_shell
