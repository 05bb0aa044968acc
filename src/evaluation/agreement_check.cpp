// Which parts of a recording are kept, and what is said of the reading that fits best.
#include "evolin_ros/evaluation/agreement_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "evolin_ros/base/text.h"
#include "photometric_agreement.h"

namespace evolin {

namespace {

using Level = Finding::Level;

constexpr const char* kSubject = "agreement";

/// Depth images that may come before their image.
constexpr std::size_t kRecentDepths = 8;

constexpr std::size_t kFewestPairs = 4;

/// Above this nothing fits: it is near what unrelated images give.
constexpr double kPoorError = 15;

/// Rounded to `digits` decimals.
std::string fixed(double value, int digits) {
  const double scale = std::pow(10, digits);
  return formatDouble(std::round(value * scale) / scale);
}

std::string framesText(int frames) {
  const std::string count = std::to_string(std::abs(frames));
  return count + (count == "1" ? " frame " : " frames ") + (frames < 0 ? "earlier" : "later");
}

std::string textOf(const Reading& reading) {
  std::string text;
  const auto join = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (reading.frames != 0) {
    join("the poses of " + framesText(reading.frames));
  }
  if (reading.seconds != 0) {
    join("the poses of " + fixed(std::abs(reading.seconds), 3) + " s " +
         (reading.seconds < 0 ? "earlier" : "later"));
  }
  if (reading.inverted) {
    join("the poses inverted");
  }
  if (reading.flipped) {
    join("fy with the other sign");
  }
  if (reading.depth != 1) {
    join("depth multiplied with " + fixed(reading.depth, 3));
  }
  return text;
}

std::string adviceOn(const Reading& reading) {
  std::string advice;
  const auto join = [&advice](const std::string& part) {
    advice += (advice.empty() ? "" : "; ") + part;
  };
  if (reading.frames != 0) {
    join(std::string(reading.frames < 0 ? "lower" : "raise") + " --pose-offset by " +
         std::to_string(std::abs(reading.frames)) +
         " (of a folder; a bag is made with it by 'evolin bag')");
  }
  if (reading.seconds != 0) {
    join("the stamps of the poses are " + fixed(std::abs(reading.seconds), 3) + " s too " +
         (reading.seconds < 0 ? "early" : "late") + ": move them");
  }
  if (reading.inverted) {
    join("the poses seem to be world to camera: expected is camera to world");
  }
  if (reading.flipped) {
    join("look at fy of the camera: it is negative where the images were made with y upwards");
  }
  if (reading.depth != 1) {
    join("divide the depth factor by " + fixed(reading.depth, 3));
  }
  return advice;
}

}  // namespace

AgreementCheck::AgreementCheck(std::size_t images, Stamp max_time_difference)
    : stride_(std::max<std::size_t>(1, images / kAnchors)),
      max_time_difference_(max_time_difference) {}

void AgreementCheck::add(const StreamPart& part) {
  if (const auto* image = std::get_if<ImagePart>(&part)) {
    addImage(*image);
  } else if (const auto* camera = std::get_if<Camera>(&part)) {
    camera_ = camera_.value_or(*camera);
  } else if (const auto* depth = std::get_if<DepthPart>(&part)) {
    for (Anchor& anchor : anchors_) {
      offerDepth(*depth, &anchor);
    }
    recent_depths_.push_back(*depth);
    if (recent_depths_.size() > kRecentDepths) {
      recent_depths_.pop_front();
    }
  } else if (const auto* pose = std::get_if<StampedPose>(&part)) {
    trajectory_.add(*pose);
  }
}

void AgreementCheck::addImage(const ImagePart& image) {
  const std::size_t number = stamps_.size();
  stamps_.push_back(image.frame.stamp);
  if (number == 1 && stamps_[1] > stamps_[0]) {
    step_ = static_cast<std::size_t>(
        std::clamp<std::int64_t>(std::llround(kSpan / toSeconds(stamps_[1] - stamps_[0])), 1, 30));
  }
  if (image.frame.image.empty()) {
    return;
  }
  const bool begins = number % stride_ == 0 && anchors_.size() < kAnchors;
  const auto waiting = std::find_if(anchors_.begin(), anchors_.end(), [&](const Anchor& anchor) {
    return anchor.number + step_ == number;
  });
  if (!begins && waiting == anchors_.end()) {
    return;
  }
  const cv::Mat gray = toGray(image.frame.image).clone();
  if (waiting != anchors_.end()) {
    waiting->later = gray;
  }
  if (begins) {
    Anchor anchor;
    anchor.number = number;
    anchor.gray = gray;
    for (const DepthPart& depth : recent_depths_) {
      offerDepth(depth, &anchor);
    }
    anchors_.push_back(std::move(anchor));
  }
}

void AgreementCheck::offerDepth(const DepthPart& depth, Anchor* anchor) const {
  const Stamp distance = std::abs(depth.stamp - stamps_.at(anchor->number));
  const ImageSize size = depth.depth.size();
  if (distance > max_time_difference_ || size.width != anchor->gray.cols ||
      size.height != anchor->gray.rows) {
    return;
  }
  if (!anchor->depth || distance < anchor->depth_distance) {
    anchor->depth = depth.depth;
    anchor->depth_distance = distance;
  }
}

std::vector<Finding> AgreementCheck::findings() const {
  if (!camera_ || trajectory_.poses().empty() ||
      std::none_of(anchors_.begin(), anchors_.end(),
                   [](const Anchor& anchor) { return anchor.depth.has_value(); })) {
    return {};
  }
  PhotometricAgreement agreement(*camera_, trajectory_, stamps_, kWorstError);
  for (const Anchor& anchor : anchors_) {
    if (anchor.depth && !anchor.later.empty()) {
      agreement.add({anchor.number, anchor.number + step_}, anchor.gray, *anchor.depth,
                    anchor.later);
    }
  }
  const std::size_t pairs = agreement.pairs(Reading());
  if (pairs < kFewestPairs) {
    return {{Level::kDoubt, kSubject,
             "cannot be measured: " + std::to_string(pairs) + " pairs of images " +
                 std::to_string(step_) + " apart have edges with depth, and poses; expected " +
                 std::to_string(kFewestPairs),
             ""}};
  }
  const double given = agreement.meanError(Reading());
  const std::string measured = " (mean error on edges " + fixed(given, 2) + " grey levels, " +
                               std::to_string(pairs) + " pairs of images)";
  const BestReading best = agreement.findBest();
  const double least = agreement.meanError(best.reading);
  if (!best.reading.isAsGiven() && least <= kPoorError) {
    return {{Level::kDoubt, kSubject,
             textOf(best.reading) + ": so images, depth and poses fit clearly better, mean error " +
                 "on edges " + fixed(least, 2) + " grey levels where as given it is " +
                 fixed(given, 2) + " (" + std::to_string(pairs) + " pairs of images)",
             adviceOn(best.reading)}};
  }
  if (given > kPoorError) {
    return {
        {Level::kDoubt, kSubject,
         "images, depth and poses do not fit" + measured + ", and no common mistake explains it",
         "repeatability and relative pose would measure the recording: look at its "
         "calibration, and whether depth is registered to the images"}};
  }
  if (!best.alternatives.empty()) {
    std::string list;
    for (const Reading& reading : best.alternatives) {
      list += (list.empty() ? "" : "; ") + textOf(reading);
    }
    return {{Level::kGood, kSubject,
             "images, depth and poses fit as given" + measured +
                 "; the motion is too small or too even to exclude: " + list,
             ""}};
  }
  return {{Level::kGood, kSubject, "images, depth and poses fit best as given" + measured, ""}};
}

}  // namespace evolin
