// rospack's look-up of this package.
#include "package_files.h"

#include <ros/package.h>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

std::filesystem::path configFolder() {
  const std::string package = ros::package::getPath("evolin_ros");
  if (package.empty()) {
    throw Error(
        "the package evolin_ros is not on ROS_PACKAGE_PATH; source the workspace's setup.bash");
  }
  return std::filesystem::path(package) / "config";
}

}  // namespace

std::filesystem::path cameraFolder() { return configFolder() / "cameras"; }

std::filesystem::path modelCatalogueFile() { return configFolder() / "models.yaml"; }

}  // namespace evolin
