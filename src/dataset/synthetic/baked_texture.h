// A patch's final look, pattern times light, as an image at several sizes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "evolin_ros/dataset/synthetic/scene.h"
#include "lighting.h"

namespace evolin::synthetic {

/// How far (u, v), in metres on a patch, moves with one pixel to the right and one down.
struct Footprint {
  float u_right = 0;
  float v_right = 0;
  float u_down = 0;
  float v_down = 0;
};

class BakedTexture {
 public:
  /// `texel`: metres a texel, at the most (a patch has at least 2 x 2).
  BakedTexture(const Patch& patch, const Lighting& lighting, double texel);

  /// Mean grey levels (blue, green, red, 0) over a pixel's footprint around (u, v); places outside
  /// the patch count as its rim.
  Eigen::Array4f at(float u, float v, const Footprint& footprint) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> texels;  ///< four bytes each
  };

  Eigen::Array4f bilinear(std::size_t level, float u, float v) const;
  void addLevels();

  std::vector<Level> levels_;  ///< each half as wide and high as the one before
  float per_metre_u_ = 1;      ///< texels of level 0
  float per_metre_v_ = 1;
};

}  // namespace evolin::synthetic
