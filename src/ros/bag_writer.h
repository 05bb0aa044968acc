// Writes frames of a dataset as a bag with the topics of TUM's own bags and the ground truth; no
// ROS header.
#pragma once

#include <filesystem>
#include <memory>

#include "evolin_ros/dataset/sequence_reader.h"

namespace evolin {

/// LZ4 is worth its time where pixels repeat themselves; sensor noise hardly gets smaller by it.
enum class BagCompression { kNone, kLz4 };

/// Images go out as bgr8 or mono8, depth as 32FC1 metres (NaN: none) at its own
/// stamp, poses as /tf and PoseStamped at the image's stamp, annotated lines with their ids.
class BagWriter {
 public:
  /// Makes `file`; throws Error naming it when that fails.
  explicit BagWriter(const std::filesystem::path& file,
                     BagCompression compression = BagCompression::kLz4);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Throws Error for a stamp that ROS cannot hold (before 1970 and at 0) and when the disk is
  /// full.
  void add(const SequenceFrame& frame);

  /// Writes the index; nothing may be added after it.
  void close();

 private:
  struct Bag;
  std::unique_ptr<Bag> bag_;
};

}  // namespace evolin
