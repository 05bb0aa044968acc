// Where network files are looked for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evolin {

/// The folders of EVOLIN_MODELS (separated by ':'), then ~/.ros/evolin_ros/models (ROS_HOME instead
/// of ~/.ros where that is set).
std::vector<std::filesystem::path> modelFolders();

/// The first file of that name in those folders; a name with a '/' is a path of its own.
std::optional<std::filesystem::path> findModelFile(const std::string& name);

/// "EVOLIN_MODELS (unset), /home/x/.ros/evolin_ros/models": for messages.
std::string searchedFolders();

}  // namespace evolin
