// Which OpenCV has the LSD that golden lines and published figures were made with.
#pragma once

#include <opencv2/core/version.hpp>
#include <string>

namespace evolin::test {

/// Why this OpenCV's LSD finds other lines than those; "" when it finds the same.
inline std::string whyLsdDiffers() {
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 8)
  return "OpenCV " CV_VERSION
         " counts the aligned points of LSD's rectangles otherwise than OpenCV "
         "before 4.8, which the golden lines and the published figures were made with";
#else
  return "";
#endif
}

}  // namespace evolin::test
