// Where the package's own files are, in a source checkout's development space as well as installed;
// no ROS header.
#pragma once

#include <filesystem>

namespace evolin {

/// The folder that holds config, launch and python. Throws Error when the package is not on the
/// package path.
std::filesystem::path packageFolder();

/// The folder of camera presets, config/cameras. Throws as packageFolder().
std::filesystem::path cameraFolder();

/// The list of network files, config/models.yaml; throws as above.
std::filesystem::path modelCatalogueFile();

}  // namespace evolin
