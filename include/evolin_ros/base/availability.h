// How a plug-in says that this build cannot run it.
#pragma once

#include <string>

namespace evolin {

/// "OpenCV 4.2.0, which this was built with, lacks WHAT: it exists since OpenCV SINCE".
std::string missingInOpenCv(const std::string& what, const std::string& since);

/// Throws UnavailableError saying `owner` and `why` unless `why` is empty.
void requireAvailable(const std::string& owner, const std::string& why);

}  // namespace evolin
