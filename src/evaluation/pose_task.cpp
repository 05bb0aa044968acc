// Both directions are estimated on their own, as in the published implementation.
#include "evolin_ros/evaluation/pose_task.h"

#include "evolin_ros/pose/evolin_pose.h"
#include "evolin_ros/pose/robust_pose.h"

namespace evolin {

namespace {

std::optional<PoseErrors> errorsOf(const RelativePose& estimate, const Pose& truth,
                                   Protocol protocol) {
  return estimate.found() ? poseErrors(truth, estimate.first_to_second, protocol) : std::nullopt;
}

}  // namespace

PoseMethod::PoseMethod(const PoseMethodOptions& options) : options_(options) {
  if (options.strategy == PoseStrategy::kRobust) {
    RobustPoseOptions robust;
    robust.seed = options.seed;
    estimator_ = std::make_shared<RobustPoseEstimator>(robust);
    return;
  }
  const bool paper = options.protocol == Protocol::kPaper;
  EvolinPoseOptions evolin;
  evolin.normalised = paper;
  estimator_ = std::make_shared<EvolinPoseEstimator>(evolin);
  endpoints_ = paper ? EndpointRule::kExact : EndpointRule::kTruncated;
}

PoseRecord runPoseTask(const PoseTask& task, const PoseMethod& method) {
  const RelativePose forward = method.estimator().estimate(task.matches, task.camera);
  const RelativePose backward = method.estimator().estimate(exchanged(task.matches), task.camera);
  const Protocol protocol = method.options().protocol;
  PoseRecord record;
  record.first_stamp = task.first_stamp;
  record.stamp = task.stamp;
  record.matched = task.matched;
  record.with_depth = task.matches.size();
  record.inliers = forward.inliers.size();
  record.truth = task.truth;
  record.pair.errors = meanErrors(errorsOf(forward, task.truth, protocol),
                                  errorsOf(backward, inverse(task.truth), protocol));
  record.pair.moved = task.truth.translation.norm();
  record.pair.ill_conditioned =
      record.pair.errors && (forward.ill_conditioned || backward.ill_conditioned);
  if (forward.found()) {
    record.estimate = forward.first_to_second;
  }
  if (!record.pair.errors) {
    const RelativePose& failed = forward.found() ? backward : forward;
    record.reason = failed.found() ? "the estimate is not finite" : failed.reason;
  }
  return record;
}

}  // namespace evolin
