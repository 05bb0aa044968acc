// Final non-linear least squares of the robust strategy.
#pragma once

#include <vector>

#include "two_view_line.h"

namespace evolin {

struct Refinement {
  Pose motion;
  int iterations = 0;
  bool usable = false;  ///< otherwise `motion` is the start
};

/// Least squares of the distances in pixels over the supported views of `lines`, each view's two
/// under one Cauchy loss of scale `loss_scale` pixels, from `start`, at most `max_steps` steps.
Refinement refineMotion(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                        const Pose& start, const Camera& camera, double loss_scale, int max_steps);

}  // namespace evolin
