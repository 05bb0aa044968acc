// A hand-held camera's way through the synthetic room, in closed form.
#pragma once

#include <cstdint>

#include "evolin_ros/geometry/pose.h"

namespace evolin::synthetic {

/// Pose (camera to world) at `time` seconds: slow waves in place, heading, pitch and roll that keep
/// the furnished corner in view; about 0.3 m/s and 15 degrees/s. `seed` shifts the waves.
Pose cameraPose(std::uint64_t seed, double time);

}  // namespace evolin::synthetic
