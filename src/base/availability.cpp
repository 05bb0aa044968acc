// How a plug-in says that this build cannot run it.
#include "evolin_ros/base/availability.h"

#include <opencv2/core/version.hpp>

#include "evolin_ros/base/error.h"

namespace evolin {

std::string missingInOpenCv(const std::string& what, const std::string& since) {
  return std::string("OpenCV " CV_VERSION ", which this was built with, lacks ") + what +
         ": it exists since OpenCV " + since;
}

void requireAvailable(const std::string& owner, const std::string& why) {
  if (!why.empty()) {
    throw UnavailableError(owner + ": " + why);
  }
}

}  // namespace evolin
