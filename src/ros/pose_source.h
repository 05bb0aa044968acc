// Ground-truth poses of the camera: from messages of several types, or from tf.
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/dataset/trajectory.h"

namespace evolin::ros_shell {

/// The camera's pose in the world out of a PoseStamped, PoseWithCovarianceStamped or Odometry.
/// Throws Error naming another type, and as fromMessage() for an unusable pose.
StampedPose poseFromAny(const topic_tools::ShapeShifter& message);

/// Looks poses up in tf's tree at the stamps that were asked for, as soon as they are known, in
/// order of time. Frame names are taken with or without a leading slash. Not safe for several
/// threads at once.
class TfPoses {
 public:
  /// Asked for but not known yet: at most this many.
  static constexpr std::size_t kMostPending = 1000;

  explicit TfPoses(const std::string& world_frame);

  /// Returns what can be looked up now. A jump back in time forgets the past.
  std::vector<StampedPose> add(const tf2_msgs::TFMessage& message, bool is_static);

  /// Asks for the pose of `camera_frame` ("" is passed over) at `stamp`, once: the first frame that
  /// is asked for at a stamp counts. Returns what can be looked up now.
  std::vector<StampedPose> ask(Stamp stamp, const std::string& camera_frame);

  /// The sequence begins anew: stamps may be asked for again.
  void startPass() { answered_.reset(); }

  std::size_t pending() const { return pending_.size(); }

  /// What keeps the oldest question from being answered; "" when nothing is asked for.
  std::string whyWaiting() const;

 private:
  enum class Answer { kPose, kNotYet, kNever };

  Answer lookUp(Stamp stamp, const std::string& camera_frame, Pose* pose) const;
  std::vector<StampedPose> answer();

  std::string world_frame_;
  tf2::BufferCore buffer_;
  std::optional<Stamp> newest_;
  std::map<Stamp, std::string> pending_;  ///< with the camera's frame
  std::optional<Stamp> answered_;         ///< the newest question that left
};

}  // namespace evolin::ros_shell
