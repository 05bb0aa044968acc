// rospack's look-up of this package.
#include "package_files.h"

#include <dlfcn.h>
#include <ros/package.h>

#include <algorithm>
#include <string>

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

std::vector<std::filesystem::path> programFiles() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files = {fs::read_symlink("/proc/self/exe")};
  static const char kHere = 0;  // in the library that this file is part of
  Dl_info library;
  if (dladdr(&kHere, &library) == 0) {
    throw Error("the package's libraries are not found beside the program");
  }
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::absolute(library.dli_fname).parent_path())) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("libevolin_", 0) == 0 && entry.path().extension() == ".so") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin() + 1, files.end());
  return files;
}

}  // namespace evolin
