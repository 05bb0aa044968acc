// Where the package's own files are, in a source checkout's development space as well as installed;
// no ROS header.
#pragma once

#include <filesystem>
#include <vector>

namespace evolin {

/// The folder that holds config, launch and python. Throws Error when the package is not on the
/// package path.
std::filesystem::path packageFolder();

/// The folder of camera presets, config/cameras. Throws as packageFolder().
std::filesystem::path cameraFolder();

/// The list of network files, config/models.yaml; throws as above.
std::filesystem::path modelCatalogueFile();

/// The files that this process's results depend on besides its inputs and foreign libraries: the
/// running program, and the package's libraries where they were loaded from, in order of name.
std::vector<std::filesystem::path> programFiles();

}  // namespace evolin
