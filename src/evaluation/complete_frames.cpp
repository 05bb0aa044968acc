// Parts wait behind the first image that still lacks something.
#include "evolin_ros/evaluation/complete_frames.h"

#include <deque>
#include <limits>
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
constexpr std::size_t kDepthsKept = 4 * kMostAhead;

void require(bool offered, bool needed, const char* what) {
  if (needed && !offered) {
    throw UnavailableError(std::string("a plug-in needs ") + what + ", but the recording has no " +
                           what);
  }
}

/// As Frame::depth wants it.
cv::Mat metresOf(const DepthMap& map) {
  cv::Mat metres(map.size().height, map.size().width, CV_32FC1);
  for (int y = 0; y < metres.rows; ++y) {
    auto* const row = metres.ptr<float>(y);
    for (int x = 0; x < metres.cols; ++x) {
      const double depth = map.at(x, y);
      row[x] = DepthMap::isDepth(depth) ? static_cast<float>(depth)
                                        : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return metres;
}

class CompleteFrames : public PartReader {
 public:
  CompleteFrames(std::unique_ptr<PartReader> reader, const Needs& needs, const WantedParts& wanted)
      : reader_(std::move(reader)),
        needs_(needs),
        wanted_(wanted),
        depths_(MotionOptions().max_time_difference, kDepthsKept) {
    const Needs offered = reader_->offers();
    require(offered.depth, needs.depth, "depth");
    require(offered.pose, needs.pose, "poses");
    require(offered.camera, needs.camera, "camera");
    needs_.camera = offered.camera;  // whoever asks for depth or poses wants it
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
      fill(&image->frame);
    }
    return part;
  }

  std::size_t images() const override { return reader_->images(); }
  std::vector<std::string> notes() const override { return reader_->notes(); }
  std::string provenance() const override { return reader_->provenance(); }
  Needs offers() const override { return reader_->offers(); }

 private:
  void take(StreamPart part) {
    bool goes_on = true;
    if (std::holds_alternative<ImagePart>(part)) {
      ++images_ahead_;
    } else if (const auto* camera = std::get_if<Camera>(&part)) {
      camera_ = *camera;
    } else if (const auto* depth = std::get_if<DepthPart>(&part)) {
      if (needs_.depth) {
        depths_.add(depth->stamp, depth->depth);
      }
      goes_on = wanted_.motion;
    } else if (const auto* pose = std::get_if<StampedPose>(&part)) {
      trajectory_.add(*pose);
      goes_on = wanted_.motion;
    }
    if (goes_on) {
      parts_.push_back(std::move(part));
    }
  }

  /// Whether nothing that the first part lacks can still come.
  bool isReady() {
    const auto* image = std::get_if<ImagePart>(&parts_.front());
    if (image == nullptr || ended_ || images_ahead_ > kMostAhead) {
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
      frame->depth = metresOf(*depth);
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
  std::size_t images_ahead_ = 0;  ///< in parts_
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<PartReader> completeFrames(std::unique_ptr<PartReader> reader, const Needs& needs,
                                           const WantedParts& wanted) {
  return std::make_unique<CompleteFrames>(std::move(reader), needs, wanted);
}

}  // namespace evolin
