// The size of an image.
#pragma once

namespace evolin {

/// Pixels.
struct ImageSize {
  int width = 0;
  int height = 0;
};

}  // namespace evolin
