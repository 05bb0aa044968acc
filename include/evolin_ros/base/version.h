// The program's name and version, as results carry them.
#pragma once

#include <string>

namespace evolin {

/// "evolin_ros 0.1.0".
std::string programVersion();

}  // namespace evolin
