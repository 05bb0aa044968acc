// Camera trajectories as text files: poses by time (TUM's format) and poses by number or row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin {

struct StampedPose {
  Stamp stamp = 0;
  Pose pose;  ///< camera to world
};

struct NumberedPose {
  std::int64_t number = 0;
  Pose pose;  ///< camera to world
};

/// Poses in order of time with a look-up between them.
class Trajectory {
 public:
  /// Neighbours farther than this from the time asked for give no pose.
  static constexpr Stamp kMaxGap = kNanosecondsPerSecond / 10;
  /// A pose this near is the pose of that time, whatever its neighbours.
  static constexpr Stamp kSameTime = 1000;

  Trajectory() = default;

  /// Throws Error when the stamps do not strictly increase.
  explicit Trajectory(std::vector<StampedPose> poses);

  const std::vector<StampedPose>& poses() const { return poses_; }

  /// Puts a pose in its place by time, at little cost where it is the newest. False, and nothing is
  /// added, when there is one of the same stamp.
  bool add(const StampedPose& pose);

  /// Lets go of poses that no look-up at `stamp` or later needs, now or at a later call: the cost
  /// of a call does not grow with the number of poses.
  void forgetBefore(Stamp stamp);

  /// The pose at `stamp`: the nearest one within kSameTime as it is, else interpolated between the
  /// two neighbours. None outside the trajectory's range, or when either neighbour is more than
  /// kMaxGap away.
  std::optional<Pose> at(Stamp stamp) const;

 private:
  std::vector<StampedPose> poses_;
};

/// Reads lines "stamp tx ty tz qx qy qz qw": seconds, metres, unit quaternion (normalised on
/// reading). Blank lines and lines that start with # are skipped. Throws ParseError with file, line
/// and value for a wrong number of fields, text, a number that is not finite, a quaternion of zero
/// norm, and stamps that do not strictly increase.
Trajectory readTrajectory(const std::filesystem::path& file);

/// The same with a whole frame number instead of the stamp, as in *.gt.freiburg of ICL-NUIM;
/// numbers must strictly increase.
std::vector<NumberedPose> readNumberedPoses(const std::filesystem::path& file);

/// The same with a first column that says nothing: poses in order of rows.
std::vector<Pose> readPoseRows(const std::filesystem::path& file);

}  // namespace evolin
