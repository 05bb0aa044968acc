// Plays back the matches that any method has written to a folder.
#pragma once

#include <optional>

#include "evolin_ros/association/line_associator.h"
#include "evolin_ros/dataset/association_folder.h"

namespace evolin {

/// Plug-in `recorded`. Parameters: `folder`, in the layout of AssociationFolder ('evolin associate'
/// writes such), and `stamps`, a stamps file where the folder has none; relative paths are taken
/// from the working directory. match() looks the pair up by the frames' stamps and throws Error
/// when it was not recorded, or when an index is beyond the lines of its frame.
class RecordedAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

 private:
  std::optional<AssociationFolder> folder_;
};

}  // namespace evolin
