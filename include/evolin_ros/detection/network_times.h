// Where the time of a detector that runs a network went.
#pragma once

namespace evolin {

/// Of the last frame, milliseconds.
struct NetworkTimes {
  double preparing = 0;  ///< the image to the network's input
  double forward = 0;    ///< the network
  double decoding = 0;   ///< its maps to lines
};

}  // namespace evolin
