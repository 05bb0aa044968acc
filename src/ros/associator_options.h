// The associator nodelet's parameters, and what follows from them for the matches that come out.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "camera_source.h"
#include "health.h"

namespace evolin::ros_shell {

struct AssociatorOptions {
  std::string associator = "lbd";
  std::string config;            ///< YAML file of the plug-in's parameters
  YAML::Node parameters;         ///< those of `config` with the node's own laid over them
  std::string source;            ///< name of the matches; "": the associator's
  std::string named_associator;  ///< whose matches `source` was first the name of
  std::string camera;            ///< preset or file; "": camera_info
  Rectify rectify = Rectify::kNever;

  // What follows is read at the start alone.
  int frame_step = 1;  ///< the evaluator's must be the same
  std::string image_transport = "raw";
  int queue_size = 30;    ///< images that may wait for their lines, and lines for their image
  bool realtime = false;  ///< only the newest frame waits for the method
  bool lazy = true;
  double warn_after = 3;
  HealthLimits health;

  std::string name() const { return source.empty() ? associator : source; }

  /// As DetectorOptions::taggedSource.
  std::string taggedSource() const;

  /// As DetectorOptions::needsRestart.
  std::string needsRestart(const AssociatorOptions& now) const;
};

/// As readDetectorOptions.
AssociatorOptions readAssociatorOptions(const YAML::Node& parameters, const std::string& owner);

}  // namespace evolin::ros_shell
