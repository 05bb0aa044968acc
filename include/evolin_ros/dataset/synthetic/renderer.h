// Pictures of a scene: colour without stair steps, and the depth at pixel centres.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "evolin_ros/dataset/synthetic/scene.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin::synthetic {

struct Rendering {
  cv::Mat color;  ///< CV_32FC3, blue green red, grey levels 0 to 255 before the sensor
  cv::Mat depth;  ///< CV_32FC1 metres along the optical axis at pixel centres; NaN: nothing there
};

class Renderer {
 public:
  /// Keeps `scene`, which must outlive it. The camera is a pinhole without distortion. What a
  /// surface looks like is computed when it is first seen, by whichever thread comes first.
  Renderer(const Scene& scene, const Camera& camera);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Safe for any number of threads; the same pose gives the same bytes. What is nearer than
  /// kNearPlane is cut away.
  Rendering render(const Pose& camera_to_world) const;

  static constexpr double kNearPlane = 0.05;  ///< m

 private:
  class Textures;

  const Scene& scene_;
  Camera camera_;
  std::unique_ptr<Textures> textures_;
};

}  // namespace evolin::synthetic
