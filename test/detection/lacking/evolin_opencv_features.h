// Stands in for the configured header: an OpenCV that lacks everything.
#pragma once

namespace evolin {

constexpr bool kOpenCvHasLsd = false;

}  // namespace evolin

#define EVOLIN_HAS_FAST_LINE_DETECTOR 0
#define EVOLIN_HAS_EDGE_DRAWING 0
#define EVOLIN_HAS_LINE_DESCRIPTOR 0
#define EVOLIN_HAS_DNN 0
