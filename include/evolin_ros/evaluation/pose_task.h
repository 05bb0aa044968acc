// The relative pose of one pair of frames, both ways, and how far it is from the truth:
// self-contained work that may be done on any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/pose.h"
#include "evolin_ros/metrics/pose_error.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/pose/relative_pose.h"

namespace evolin {

struct PoseMethodOptions {
  Protocol protocol = Protocol::kEvolin;
  PoseStrategy strategy = PoseStrategy::kEvolin;
  std::uint64_t seed = 1;  ///< of the robust strategy's sampling
};

/// What strategy and protocol mean together. The robust strategy is in no protocol's tables and
/// takes endpoints as exactly as they are known. Safe for several threads.
class PoseMethod {
 public:
  explicit PoseMethod(const PoseMethodOptions& options);

  const PoseMethodOptions& options() const { return options_; }
  const RelativePoseEstimator& estimator() const { return *estimator_; }
  EndpointRule endpoints() const { return endpoints_; }

 private:
  PoseMethodOptions options_;
  std::shared_ptr<const RelativePoseEstimator> estimator_;
  EndpointRule endpoints_ = EndpointRule::kExact;
};

struct PoseTask {
  Stamp first_stamp = 0;
  Stamp stamp = 0;
  SpatialMatches matches;
  std::size_t matched = 0;  ///< pairs of lines before those without depth were left out
  Camera camera;
  Pose truth;  ///< maps points of the first camera to the second
};

/// What came of it.
struct PoseRecord {
  Stamp first_stamp = 0;
  Stamp stamp = 0;
  int frame_step = 0;            ///< images from the first to the second; 0: not known
  std::size_t matched = 0;       ///< pairs of lines
  std::size_t with_depth = 0;    ///< of these
  std::size_t inliers = 0;       ///< of these, first to second
  PosePair pair;                 ///< errors: mean of both directions
  Pose truth;                    ///< first to second
  std::optional<Pose> estimate;  ///< first to second; none where that direction failed
  std::string reason;            ///< why there are no errors; "" when there are
};

PoseRecord runPoseTask(const PoseTask& task, const PoseMethod& method);

}  // namespace evolin
