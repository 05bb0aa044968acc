// Any associator with its matches verified: those stay that one motion of the camera explains.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "evolin_ros/association/geometric_matching.h"
#include "evolin_ros/association/line_associator.h"
#include "evolin_ros/pose/match_verification.h"

namespace evolin {

/// Parameters that begin with this word are the verification's own, whatever the associator.
constexpr const char* kVerifyPrefix = "verify";

/// Takes `verify` (none, pose), `verify_threshold` and `verify_min_inliers` out of the parameters
/// and gives the others to the associator inside; without them, and with `verify: none`, it is that
/// associator and nothing else. With `verify: pose` it needs depth and the camera besides, and of
/// two frames whose matches agree on no motion it keeps no match. Each frame's own camera counts,
/// with its lens distortion; the threshold is in pixels of the first one's, without distortion.
/// Throws Error naming the frame where depth or the camera is missing.
class VerifiedAssociator : public LineAssociator {
 public:
  /// `name` is the plug-in's, for messages.
  VerifiedAssociator(const std::string& name, std::shared_ptr<LineAssociator> inner);

  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override { return inner_->whyUnavailable(); }
  Needs needs() const override;
  void describe(const FrameLines& lines) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;
  MatchCounts counts() const override;

 private:
  std::string owner_;
  std::shared_ptr<LineAssociator> inner_;
  bool verifies_ = false;
  MatchVerificationOptions options_;
  std::size_t pairs_ = 0;
  std::size_t pairs_without_motion_ = 0;
  std::map<PoseFailure, std::size_t> failures_;  ///< of these pairs
  std::size_t matches_ = 0;
  std::size_t kept_ = 0;
  std::size_t without_depth_ = 0;
};

}  // namespace evolin
