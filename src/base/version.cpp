// The version that CMake passes in from package.xml's project.
#include "evolin_ros/base/version.h"

namespace evolin {

std::string programVersion() { return "evolin_ros " EVOLIN_VERSION; }

}  // namespace evolin
