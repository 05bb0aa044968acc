// What a picture shows as markers for RViz, on the image plane before the camera.
#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "evolin_ros/drawing/evaluation_view.h"
#include "evolin_ros/geometry/camera.h"

namespace evolin::ros_shell {

/// Namespaces, each with one marker of id 0: `true_positives`, `false_positives`, `misses`,
/// `not_scored`, `detected` (lines that nobody judged), `trails`, `image_border`. A namespace
/// without lines is deleted. Layers that `options` leave out are not there.
///
/// Points lie where the camera's pinhole model puts pixels on the plane `distance` metres before
/// it; its distortion is left aside, as a flat picture leaves it aside. `anew` puts a DELETEALL in
/// front. The frame's leading slash is taken away.
visualization_msgs::MarkerArray toMarkers(const std_msgs::Header& header, const Camera& camera,
                                          double distance, const EvaluatedFrame& frame,
                                          const ViewOptions& options, bool anew);

/// Takes all markers of the topic away. The frame's leading slash is taken away.
visualization_msgs::MarkerArray noMarkers(const std_msgs::Header& header);

}  // namespace evolin::ros_shell
