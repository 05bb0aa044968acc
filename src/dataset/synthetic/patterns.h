// What surfaces look like in even light: wood, wallpaper, book spines, a view out of the window.
#pragma once

#include "evolin_ros/dataset/synthetic/scene.h"

namespace evolin::synthetic {

/// Reflectance of a patch of `width` x `height` metres at (u, v) metres from its origin.
Color reflectance(const Material& material, double u, double v, double width, double height);

}  // namespace evolin::synthetic
