// How many ground-truth pixels the cheapest one-to-one matching with predicted pixels matches: the
// count behind the heatmap metrics (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include <cstddef>
#include <vector>

#include "evolin_ros/base/deadline.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/metrics/rasterization.h"

namespace evolin {

/// A pair of pixels may match when it is at most `reach` pixels apart (Euclidean distance), at the
/// cost of its distance + 1e-6. A ground-truth pixel with any predicted pixel within reach may stay
/// free at `free_cost`; other pixels stay free at no cost.
struct PixelMatchingRule {
  int reach = 1;
  double free_cost = 0;
};

/// reach = ceil(0.01 * diagonal) (8 at 640 x 480), free_cost = the diagonal in pixels. Throws Error
/// for an image without size.
PixelMatchingRule pixelMatchingRule(ImageSize size);

/// Entry k: how many ground-truth pixels the matching of least cost matches with the predicted
/// pixels of levels 0 to k, where level k adds `added[k]` to the levels before it. The count is the
/// exact optimum in every case, also where that is less than the largest number of pairs, and for a
/// diagonal as free cost no two optima differ in it (proof at the implementation). Pixels lie in
/// the image; `ground_truth` has no pixel twice, nor have all levels together. Throws Error for an
/// image without size, a reach below 1, or a free cost that is not positive and finite, and
/// DeadlineError when `deadline` passes before the count is known.
std::vector<std::size_t> countMatchedPixels(ImageSize size, const PixelMatchingRule& rule,
                                            const Pixels& ground_truth,
                                            const std::vector<Pixels>& added,
                                            const Deadline& deadline = {});

}  // namespace evolin
