// Line segments as pixels, drawn as the heatmap metrics of the EVOLIN benchmark draw them (Ivanov,
// Ferrer, Kornilova 2023).
#pragma once

#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Column and row, both from 0.
struct Pixel {
  int x = 0;
  int y = 0;
};

inline bool operator==(const Pixel& a, const Pixel& b) { return a.x == b.x && a.y == b.y; }

using Pixels = std::vector<Pixel>;

/// Appends the pixels of `line` from its first to its second endpoint, each once. Endpoints are cut
/// to whole numbers towards zero, then clamped to the image; one sample a pixel of the longer axis,
/// rounded half to even. A line without length is one pixel. Exchanging the endpoints gives the
/// same pixels but where the exact line passes halfway between two of them and the step is not a
/// finite binary fraction: rounding errors then decide, from one end upwards and from the other
/// downwards. Throws Error for a line that is not finite and for an image without size.
void rasterize(const LineSegment& line, ImageSize size, Pixels* pixels);

}  // namespace evolin
