// Looking for network files.
#include "evolin_ros/inference/model_files.h"

#include <cstdlib>

#include "evolin_ros/base/text.h"

namespace evolin {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return value == nullptr ? std::string() : std::string(value);
}

std::vector<std::filesystem::path> namedFolders() {
  std::vector<std::filesystem::path> folders;
  const std::string value = variable("EVOLIN_MODELS");
  for (const std::string_view folder : split(value, ':')) {
    if (!folder.empty()) {
      folders.emplace_back(folder);
    }
  }
  return folders;
}

}  // namespace

std::vector<std::filesystem::path> modelFolders() {
  std::vector<std::filesystem::path> folders = namedFolders();
  const std::string ros_home = variable("ROS_HOME");
  const std::string home = variable("HOME");
  if (!ros_home.empty()) {
    folders.push_back(std::filesystem::path(ros_home) / "evolin_ros" / "models");
  } else if (!home.empty()) {
    folders.push_back(std::filesystem::path(home) / ".ros" / "evolin_ros" / "models");
  }
  return folders;
}

std::optional<std::filesystem::path> findModelFile(const std::string& name) {
  std::error_code ignored;
  if (name.find('/') != std::string::npos) {
    return std::filesystem::is_regular_file(name, ignored)
               ? std::optional<std::filesystem::path>(name)
               : std::nullopt;
  }
  for (const std::filesystem::path& folder : modelFolders()) {
    std::filesystem::path file = folder / name;
    if (std::filesystem::is_regular_file(file, ignored)) {
      return file;
    }
  }
  return std::nullopt;
}

std::string searchedFolders() {
  std::string text;
  if (namedFolders().empty()) {
    text = "EVOLIN_MODELS (unset)";
  }
  for (const std::filesystem::path& folder : modelFolders()) {
    text += (text.empty() ? "" : ", ") + folder.string();
  }
  return text;
}

}  // namespace evolin
