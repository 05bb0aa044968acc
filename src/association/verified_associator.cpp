// The verification's parameters, its lines in space beside the inner description, one camera for
// the lines of two, and its counts.
#include "evolin_ros/association/verified_associator.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <any>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/geometry/lens_distortion.h"

namespace evolin {

namespace {

/// A frame's lines and where they are in space, as if its camera had no distortion.
struct RectifiedLines {
  LineSegments lines;
  SpatialSegments in_space;
};

/// What FrameLines::description holds: the lines in space beside what the inner associator keeps.
struct VerifiedDescription {
  std::any inner;
  std::optional<RectifiedLines> rectified;
};

/// The line between what `map` makes of its ends (pixels as Eigen::Vector2d); one that is not
/// finite, and that verification drops, where it makes nothing of one.
template <typename Map>
LineSegment mapEnds(LineSegment line, const Map& map) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::optional<Eigen::Vector2d> first = map(Eigen::Vector2d(line.x1, line.y1));
  const std::optional<Eigen::Vector2d> second = map(Eigen::Vector2d(line.x2, line.y2));
  line.x1 = first && second ? first->x() : kNan;
  line.y1 = first && second ? first->y() : kNan;
  line.x2 = first && second ? second->x() : kNan;
  line.y2 = first && second ? second->y() : kNan;
  return line;
}

Eigen::Vector2d directionOf(const Eigen::Vector2d& pixel, const Camera& camera) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
}

Eigen::Vector2d pixelOf(const Eigen::Vector2d& direction, const Camera& camera) {
  return {camera.fx * direction.x() + camera.cx, camera.fy * direction.y() + camera.cy};
}

/// Takes the lens out of lines and of the ends of what liftIntoSpace() made of them.
void removeDistortion(const Camera& camera, RectifiedLines* rectified) {
  const LensDistortion lens(camera);
  const auto without_lens = [&](const Eigen::Vector2d& pixel) -> std::optional<Eigen::Vector2d> {
    const auto direction = lens.undistort(directionOf(pixel, camera));
    return direction ? std::optional<Eigen::Vector2d>(pixelOf(*direction, camera)) : std::nullopt;
  };
  for (LineSegment& line : rectified->lines) {
    line = mapEnds(line, without_lens);
  }
  for (std::optional<Segment3d>& segment : rectified->in_space) {
    if (!segment) {
      continue;
    }
    const auto first = lens.undistort(segment->p1.hnormalized());
    const auto second = lens.undistort(segment->p2.hnormalized());
    if (first && second) {
      segment->p1 = segment->p1.z() * Eigen::Vector3d(first->homogeneous());
      segment->p2 = segment->p2.z() * Eigen::Vector3d(second->homogeneous());
    } else {
      segment.reset();
    }
  }
}

/// Where a pinhole camera `to` in the place of `from` has the lines.
LineSegments seenBy(const Camera& to, const Camera& from, LineSegments lines) {
  for (LineSegment& line : lines) {
    line = mapEnds(line, [&](const Eigen::Vector2d& pixel) {
      return std::optional<Eigen::Vector2d>(pixelOf(directionOf(pixel, from), to));
    });
  }
  return lines;
}

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

  const RectifiedLines& rectified(const char* owner) {
    if (!mine_.rectified || mine_.rectified->lines.size() != frame_.lines.size()) {
      RectifiedLines lifted{frame_.lines, liftIntoSpace(frame_, owner)};
      if (hasDistortion(*frame_.frame.camera)) {
        removeDistortion(*frame_.frame.camera, &lifted);
      }
      mine_.rectified = std::move(lifted);
    }
    return *mine_.rectified;
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
  frame.rectified(owner_.c_str());
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
  const RectifiedLines& of_first = lent_first.rectified(owner_.c_str());
  const RectifiedLines& of_second = lent_second ? lent_second->rectified(owner_.c_str()) : of_first;
  const Camera& camera = *first.frame.camera;
  const Camera& other = *second.frame.camera;
  std::optional<LineSegments> moved;
  if (!sameIntrinsics(camera, other)) {
    moved = seenBy(camera, other, of_second.lines);
  }
  LineMatches matches = inner_->match(first, second);
  const MatchVerification verified = verifyByPose(
      {of_first.lines, of_first.in_space}, {moved ? *moved : of_second.lines, of_second.in_space},
      matches, camera, options_);
  ++pairs_;
  if (!verified.found()) {
    ++pairs_without_motion_;
    ++failures_[verified.failure];
  }
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
    for (const auto& [failure, pairs] : failures_) {
      counts["pairs of frames without a motion: " + toString(failure)] += pairs;
    }
  }
  return counts;
}

}  // namespace evolin
