// rospack's look-up of this package.
#include "package_files.h"

#include <ros/package.h>

#include "evolin_ros/base/error.h"

namespace evolin {

std::filesystem::path packageFolder() {
  const std::string package = ros::package::getPath("evolin_ros");
  if (package.empty()) {
    throw Error(
        "the package evolin_ros is not on ROS_PACKAGE_PATH; source the workspace's setup.bash");
  }
  return package;
}

std::filesystem::path cameraFolder() { return packageFolder() / "config" / "cameras"; }

std::filesystem::path modelCatalogueFile() { return packageFolder() / "config" / "models.yaml"; }

}  // namespace evolin
