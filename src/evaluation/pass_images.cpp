// Which of the stamps that tell of images are images of their own.
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>

#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

namespace {

/// As many later frames with lines leave no doubt that a frame's own will not come.
constexpr std::size_t kOvertaken = 8;

}  // namespace

void PassEvaluation::noteLines(Stamp stamp) {
  newest_with_lines_.insert(stamp);
  if (newest_with_lines_.size() > kOvertaken) {
    newest_with_lines_.erase(newest_with_lines_.begin());
  }
}

EvaluationUpdate PassEvaluation::addImage(Stamp stamp) {
  EvaluationUpdate update;
  Entry& entry = entryAt(stamp);
  const bool has_frame = entry.record.lines || entry.record.ground_truth;
  if (!entry.image && has_frame) {
    ++exact_images_;
  } else if (!has_frame) {
    images_alone_.insert(stamp);
  }
  entry.image = true;
  take(times_.measure(motionStage(), [&] { return motion_.addImage(stamp); }), &update);
  settleImages(&update);
  return update;
}

/// Lines or ground truth have come for `entry`; neither was there before its first.
void PassEvaluation::noteFrame(Stamp stamp, const Entry& entry) {
  if (entry.record.lines || entry.record.ground_truth) {
    return;
  }
  ++frames_heard_;
  images_alone_.erase(stamp);
  images_doubted_.erase(stamp);
  exact_images_ += entry.image ? 1 : 0;
}

/// The nearest frame that has no image of its own stamp, within reach of `image`.
std::optional<Stamp> PassEvaluation::nearestFrameTo(Stamp image) const {
  const Stamp reach = options_.motion.max_time_difference;
  std::optional<Stamp> nearest;
  for (auto entry = entries_.lower_bound(image - reach);
       entry != entries_.end() && entry->first <= image + reach; ++entry) {
    const bool has_frame = entry->second.record.lines || entry->second.record.ground_truth;
    if (has_frame && !entry->second.image &&
        (!nearest || std::abs(entry->first - image) < std::abs(*nearest - image))) {
      nearest = entry->first;
    }
  }
  return nearest;
}

bool PassEvaluation::standsForAnother(Stamp image) const {
  if (frames_heard_ == 0) {
    return false;
  }
  return exact_images_ == 0 || nearestFrameTo(image).has_value();
}

/// By what has been heard of so far.
int PassEvaluation::stepBetween(Stamp first, Stamp second) const {
  int step = 0;
  const auto end = entries_.upper_bound(second);
  for (auto entry = entries_.upper_bound(first); entry != end; ++entry) {
    const bool has_frame = entry->second.record.lines || entry->second.record.ground_truth;
    step += has_frame || !standsForAnother(entry->first) ? 1 : 0;
  }
  return step;
}

std::vector<Stamp> PassEvaluation::imagesOfOthers() const {
  std::vector<Stamp> images;
  if (frames_heard_ == 0) {
    return images;
  }
  for (const std::set<Stamp>* alone : {&images_alone_, &images_doubted_}) {
    std::copy_if(alone->begin(), alone->end(), std::back_inserter(images),
                 [this](Stamp image) { return standsForAnother(image); });
  }
  std::sort(images.begin(), images.end());
  return images;
}

/// Decides on images that later frames have overtaken, before frame steps count them.
void PassEvaluation::settleImages(EvaluationUpdate* update) {
  while (!images_alone_.empty() && (images_alone_.size() > options_.buffer ||
                                    (newest_with_lines_.size() == kOvertaken &&
                                     *images_alone_.begin() < *newest_with_lines_.begin()))) {
    const Stamp image = *images_alone_.begin();
    images_alone_.erase(images_alone_.begin());
    if (!standsForAnother(image)) {
      continue;
    }
    if (!std::exchange(image_offset_told_, true)) {
      update->image_offset = offsetOf(image);
    }
    motion_.removeImage(image);
    // Where images lag far behind, the first that has the stamp of a frame may still come.
    if (exact_images_ == 0 && images_doubted_.size() < options_.buffer) {
      images_doubted_.insert(image);
    } else {
      dropped_image_offset_ = dropped_image_offset_.value_or(offsetOf(image));
      entries_.erase(image);
      coverage_.remove(FrameState::kWaiting);
    }
  }
}

/// Distance in time to the nearest frame, whatever its own image; there is one.
Stamp PassEvaluation::offsetOf(Stamp image) const {
  const auto is_frame = [](const auto& entry) {
    return entry.second.record.lines || entry.second.record.ground_truth;
  };
  const auto here = entries_.lower_bound(image);
  const auto after = std::find_if(here, entries_.end(), is_frame);
  const auto before = std::find_if(std::make_reverse_iterator(here), entries_.rend(), is_frame);
  Stamp offset = std::numeric_limits<Stamp>::max();
  if (after != entries_.end()) {
    offset = after->first - image;
  }
  return before == entries_.rend() ? offset : std::min(offset, image - before->first);
}

std::string PassEvaluation::imageOffsetNote() const {
  const std::vector<Stamp> others = imagesOfOthers();
  if (!dropped_image_offset_ && others.empty()) {
    return {};
  }
  const Stamp offset = dropped_image_offset_ ? *dropped_image_offset_ : offsetOf(others.front());
  return "camera_info: its stamps are not those of the lines and of the ground truth, the nearest "
         "is " +
         formatDouble(toSeconds(offset)) +
         " s away, expected the stamp of its image; it tells of no images then, its intrinsics are "
         "taken all the same";
}

}  // namespace evolin
