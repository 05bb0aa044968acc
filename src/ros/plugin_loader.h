// Finds and loads detector and associator plug-ins of every package; no ROS header, so that the
// program uses it too.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "evolin_ros/association/line_associator.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// A plug-in as its XML declares it, and whether this build can run it.
struct PluginInfo {
  std::string name;
  std::string description;
  std::string package;
  std::string why_unavailable;  ///< "" when it can be used
};

/// Needs no running master. The objects that it gives out keep their library loaded.
class PluginLoader {
 public:
  /// Throws Error when the plug-in descriptions cannot be read.
  PluginLoader();
  ~PluginLoader();
  PluginLoader(const PluginLoader&) = delete;
  PluginLoader& operator=(const PluginLoader&) = delete;

  /// Not yet configured. Throws Error naming the plug-in: unknown (with the nearest known one) or a
  /// library that does not load.
  std::shared_ptr<LineDetector> loadDetector(const std::string& name);
  /// An associator takes the parameters of VerifiedAssociator besides its own.
  std::shared_ptr<LineAssociator> loadAssociator(const std::string& name);

  /// The file of the library that holds the plug-in; throws as above.
  std::filesystem::path detectorLibrary(const std::string& name);
  std::filesystem::path associatorLibrary(const std::string& name);

  /// Sorted by name. A plug-in whose library does not load is listed with that as its reason.
  std::vector<PluginInfo> listDetectors();
  std::vector<PluginInfo> listAssociators();

 private:
  struct Loaders;
  std::shared_ptr<Loaders> loaders_;
};

}  // namespace evolin
