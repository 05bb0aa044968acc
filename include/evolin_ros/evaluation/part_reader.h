// A recording as a stream of the parts that the evaluation takes in, whatever it is stored in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "evolin_ros/dataset/needs.h"
#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

/// An image of the camera. `frame.name` is the stem of its file, or its number where it has none.
struct ImagePart {
  Frame frame;          ///< without pixels when it could not be read
  std::string problem;  ///< why; "" when it was
};

struct DepthPart {
  Stamp stamp = 0;
  DepthMap depth;
};

/// A LineSet is ground truth.
using StreamPart = std::variant<ImagePart, Camera, DepthPart, StampedPose, LineSet>;

/// Parts in the order in which they were recorded. Not safe for several threads.
class PartReader {
 public:
  PartReader() = default;
  PartReader(const PartReader&) = delete;
  PartReader& operator=(const PartReader&) = delete;
  virtual ~PartReader() = default;

  /// None at the end. Throws Error naming the file for what cannot be read at all.
  virtual std::optional<StreamPart> next() = 0;

  /// Images to come, as far as it is known beforehand.
  virtual std::size_t images() const = 0;

  /// What its frames can be given, as far as it is known beforehand; requireOffered() asks.
  virtual Needs offers() const { return {true, true, true}; }

  /// What the user must know of the recording; complete once next() has given none.
  virtual std::vector<std::string> notes() const = 0;

  /// What was read and how, as JSON, for the report.
  virtual std::string provenance() const = 0;
};

/// Which parts are worth reading.
struct WantedParts {
  bool motion = true;  ///< depth and poses
  bool ground_truth = true;
};

/// The parts of a dataset folder. Depth has the stamp of the image that the dataset pairs it with.
/// Throws as openSequence().
std::unique_ptr<PartReader> openFolderParts(const std::filesystem::path& folder,
                                            const SequenceOptions& options,
                                            const WantedParts& wanted);

}  // namespace evolin
