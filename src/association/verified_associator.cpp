// The verification's parameters, its lines in space beside the inner description, and its counts.
#include "evolin_ros/association/verified_associator.h"

#include <any>
#include <optional>
#include <string_view>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

/// What FrameLines::description holds: the lines in space beside what the inner associator keeps.
struct VerifiedDescription {
  std::any inner;
  std::optional<SpatialSegments> in_space;
};

/// Leaves the frame to the inner associator with its own description, and takes it back in the end.
class LentFrame {
 public:
  explicit LentFrame(const FrameLines& frame) : frame_(frame) {
    if (auto* known = std::any_cast<VerifiedDescription>(&frame.description)) {
      mine_ = std::move(*known);
      frame.description = std::move(mine_.inner);
    }
  }
  ~LentFrame() {
    mine_.inner = std::move(frame_.description);
    frame_.description = std::move(mine_);
  }
  LentFrame(const LentFrame&) = delete;
  LentFrame& operator=(const LentFrame&) = delete;

  const SpatialSegments& inSpace(const char* owner) {
    if (!mine_.in_space || mine_.in_space->size() != frame_.lines.size()) {
      mine_.in_space = liftIntoSpace(frame_, owner);
    }
    return *mine_.in_space;
  }

 private:
  const FrameLines& frame_;
  VerifiedDescription mine_;
};

/// The verification's parameters, or those of the associator inside.
YAML::Node partOf(const YAML::Node& parameters, bool of_verification) {
  YAML::Node part(YAML::NodeType::Map);
  if (parameters.IsMap()) {
    for (const auto& entry : parameters) {
      const bool is_own =
          entry.first.IsScalar() && entry.first.Scalar().rfind(kVerifyPrefix, 0) == 0;
      if (is_own == of_verification) {
        part[entry.first] = entry.second;
      }
    }
  }
  return part;
}

}  // namespace

VerifiedAssociator::VerifiedAssociator(const std::string& name,
                                       std::shared_ptr<LineAssociator> inner)
    : owner_("associator " + name), inner_(std::move(inner)) {}

void VerifiedAssociator::configure(const YAML::Node& parameters) {
  const YAML::Node own = partOf(parameters, true);
  inner_->configure(parameters.IsMap() ? partOf(parameters, false) : parameters);
  MatchVerificationOptions read;
  auto min_inliers = static_cast<int>(read.min_inliers);
  std::string verify = "none";
  ParameterReader reader(own, owner_);
  reader.read("verify", &verify, {"none", "pose"});
  reader.read("verify_threshold", &read.threshold, 0.01, 1000);
  reader.read("verify_min_inliers", &min_inliers, 3, 1000000);
  reader.finish();
  if (own.size() > 0 && !own["verify"].IsDefined()) {
    throw ConfigError(owner_, own.begin()->first.Scalar(),
                      "is given without 'verify', expected verify: pose or none beside it");
  }
  read.min_inliers = static_cast<std::size_t>(min_inliers);
  options_ = read;
  verifies_ = verify == "pose";
}

Needs VerifiedAssociator::needs() const {
  Needs needs = inner_->needs();
  needs.depth = needs.depth || verifies_;
  needs.camera = needs.camera || verifies_;
  return needs;
}

void VerifiedAssociator::describe(const FrameLines& lines) {
  if (!verifies_) {
    inner_->describe(lines);
    return;
  }
  LentFrame frame(lines);
  inner_->describe(lines);
  frame.inSpace(owner_.c_str());
}

LineMatches VerifiedAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!verifies_) {
    return inner_->match(first, second);
  }
  LentFrame lent_first(first);
  std::optional<LentFrame> lent_second;
  if (&second != &first) {
    lent_second.emplace(second);
  }
  const SpatialSegments& of_first = lent_first.inSpace(owner_.c_str());
  const SpatialSegments& of_second = lent_second ? lent_second->inSpace(owner_.c_str()) : of_first;
  LineMatches matches = inner_->match(first, second);
  const MatchVerification verified = verifyByPose(
      {first.lines, of_first}, {second.lines, of_second}, matches, *first.frame.camera, options_);
  ++pairs_;
  pairs_without_motion_ += verified.found ? 0 : 1;
  matches_ += matches.size();
  kept_ += verified.kept.size();
  without_depth_ += verified.without_depth;
  LineMatches kept;
  kept.reserve(verified.kept.size());
  for (const std::size_t place : verified.kept) {
    kept.push_back(matches[place]);
  }
  return kept;
}

MatchCounts VerifiedAssociator::counts() const {
  MatchCounts counts = inner_->counts();
  if (verifies_) {
    counts["matches before verification"] += matches_;
    counts["matches kept by it"] += kept_;
    counts["matches without depth in either frame, dropped"] += without_depth_;
    counts["pairs of frames verified"] += pairs_;
    counts["pairs of frames without a motion, all their matches dropped"] += pairs_without_motion_;
  }
  return counts;
}

}  // namespace evolin
