// Parts wait behind the first image that still lacks something.
#include "evolin_ros/evaluation/complete_frames.h"

#include <deque>
#include <string>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/motion_evaluation.h"
#include "evolin_ros/evaluation/stamped_depth.h"

namespace evolin {

namespace {

/// Two seconds of a usual camera: what was not recorded by then was not recorded.
constexpr std::size_t kMostAhead = 64;
/// Depth may come more often than images.
constexpr std::size_t kDepthsKept = 2 * kMostAhead;
/// An image that is older than the one before it by less was swapped with it; by more, time jumped
/// back, and what was recorded before belongs to another pass.
constexpr Stamp kMostSwapped = Trajectory::kMaxGap;

void require(bool offered, bool needed, const char* what) {
  if (needed && !offered) {
    throw UnavailableError(std::string("a plug-in needs ") + what + ", but the recording has no " +
                           what);
  }
}

class CompleteFrames : public PartReader {
 public:
  CompleteFrames(std::unique_ptr<PartReader> reader, const Needs& needs, const WantedParts& wanted)
      : reader_(std::move(reader)),
        needs_(needs),
        wanted_(wanted),
        depths_(MotionOptions().max_time_difference, kDepthsKept) {
    requireOffered(*reader_, needs);
    needs_.camera = reader_->offers().camera;  // whoever asks for depth or poses wants it
  }

  std::optional<StreamPart> next() override {
    while (parts_.empty() || !isReady()) {
      std::optional<StreamPart> part = reader_->next();
      if (part) {
        take(std::move(*part));
      } else if (parts_.empty()) {
        return std::nullopt;
      } else {
        ended_ = true;
      }
    }
    StreamPart part = std::move(parts_.front());
    parts_.pop_front();
    if (auto* image = std::get_if<ImagePart>(&part)) {
      --images_ahead_;
      if (filled_ == 0) {
        fill(&image->frame);
        depths_.trim(image->frame.stamp, [](Stamp) { return true; });
        trajectory_.forgetBefore(image->frame.stamp);
      }
    }
    filled_ -= filled_ > 0 ? 1 : 0;
    return part;
  }

  std::size_t images() const override { return reader_->images(); }
  std::vector<std::string> notes() const override { return reader_->notes(); }
  std::string provenance() const override { return reader_->provenance(); }
  Needs offers() const override { return reader_->offers(); }

 private:
  void take(StreamPart part) {
    bool goes_on = true;
    if (const auto* image = std::get_if<ImagePart>(&part)) {
      const Stamp stamp = image->frame.stamp;
      if (stamp != 0) {  // else it could not be read so far
        if (last_image_ && stamp + kMostSwapped < *last_image_) {
          beginPass(stamp);
        }
        last_image_ = stamp;
      }
      since_image_.clear();
      ++images_ahead_;
    } else if (const auto* camera = std::get_if<Camera>(&part)) {
      camera_ = *camera;
    } else if (!std::holds_alternative<LineSet>(part)) {
      keep(part);
      since_image_.push_back(part);
      if (since_image_.size() > kMostAhead) {
        since_image_.pop_front();
      }
      goes_on = wanted_.motion;
    }
    if (goes_on) {
      parts_.push_back(std::move(part));
    }
  }

  /// Depth or a pose, for the images.
  void keep(const StreamPart& part) {
    if (const auto* pose = std::get_if<StampedPose>(&part)) {
      trajectory_.add(*pose);
    } else if (needs_.depth) {
      const auto& depth = std::get<DepthPart>(part);
      depths_.add(depth.stamp, depth.depth);
    }
  }

  static Stamp stampOf(const StreamPart& part) {
    const auto* pose = std::get_if<StampedPose>(&part);
    return pose != nullptr ? pose->stamp : std::get<DepthPart>(part).stamp;
  }

  /// Images that wait get what there is: nothing of their time can come any more. What came since
  /// the last of them may be of the new pass, whose first image has this `stamp`.
  void beginPass(Stamp stamp) {
    for (std::size_t i = filled_; i < parts_.size(); ++i) {
      if (auto* image = std::get_if<ImagePart>(&parts_[i])) {
        fill(&image->frame);
      }
    }
    filled_ = parts_.size();
    depths_ = StampedDepth(MotionOptions().max_time_difference, kDepthsKept);
    trajectory_ = {};
    const Stamp middle = stamp + (*last_image_ - stamp) / 2;
    for (const StreamPart& part : since_image_) {
      if (stampOf(part) < middle) {
        keep(part);
      }
    }
  }

  /// Whether nothing that the first part lacks can still come.
  bool isReady() {
    const auto* image = std::get_if<ImagePart>(&parts_.front());
    if (image == nullptr || filled_ > 0 || ended_ || images_ahead_ > kMostAhead) {
      return true;
    }
    const Stamp stamp = image->frame.stamp;
    const DepthMap* depth = nullptr;
    return (!needs_.depth || depths_.find(stamp, false, &depth) != Lookup::kNotYet) &&
           (!needs_.pose || trajectory_.at(stamp) || isPast(stamp)) && (!needs_.camera || camera_);
  }

  bool isPast(Stamp stamp) const {
    return !trajectory_.poses().empty() && trajectory_.poses().back().stamp > stamp;
  }

  void fill(Frame* frame) {
    const DepthMap* depth = nullptr;
    if (needs_.depth && depths_.find(frame->stamp, true, &depth) == Lookup::kFound) {
      frame->depth = depth->metres();
    }
    if (needs_.pose) {
      frame->pose = trajectory_.at(frame->stamp);
    }
    if (camera_) {
      frame->camera = camera_;
    }
  }

  std::unique_ptr<PartReader> reader_;
  Needs needs_;
  WantedParts wanted_;
  StampedDepth depths_;
  Trajectory trajectory_;
  std::optional<Camera> camera_;  ///< the newest
  std::deque<StreamPart> parts_;
  std::size_t images_ahead_ = 0;        ///< in parts_
  std::size_t filled_ = 0;              ///< parts at the head of parts_ that lack nothing
  std::deque<StreamPart> since_image_;  ///< depth and poses, the newest of them
  std::optional<Stamp> last_image_;
  bool ended_ = false;
};

}  // namespace

void requireOffered(const PartReader& reader, const Needs& needs) {
  const Needs offered = reader.offers();
  require(offered.depth, needs.depth, "depth");
  require(offered.pose, needs.pose, "poses");
  require(offered.camera, needs.camera, "camera");
}

std::unique_ptr<PartReader> completeFrames(std::unique_ptr<PartReader> reader, const Needs& needs,
                                           const WantedParts& wanted) {
  return std::make_unique<CompleteFrames>(std::move(reader), needs, wanted);
}

}  // namespace evolin
