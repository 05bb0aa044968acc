// Frames that leave a pass: to the pass of other settings that begins with them, or on purpose.
#include <iterator>

#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

namespace {

template <class Pairs>
void forgetPairsFrom(Stamp boundary, Pairs* pairs) {
  for (auto pair = pairs->begin(); pair != pairs->end();) {
    pair = pair->first.second >= boundary ? pairs->erase(pair) : std::next(pair);
  }
}

}  // namespace

void PassEvaluation::forgetFrom(Stamp boundary) {
  for (auto place = entries_.lower_bound(boundary); place != entries_.end();) {
    const auto& [stamp, entry] = *place;
    if (entry.number) {
      ++place;
      continue;
    }
    coverage_.remove(entry.record.state);
    held_.erase(stamp);
    images_alone_.erase(stamp);
    images_doubted_.erase(stamp);
    if (entry.record.ground_truth) {
      --frames_heard_;
      --ground_truth_seen_;
      exact_images_ -= entry.image ? 1 : 0;
    }
    place = entries_.erase(place);
  }
  forgetPairsFrom(boundary, &pending_pairs_);
  forgetPairsFrom(boundary, &pending_detected_pairs_);
  motion_.forgetFrom(boundary);
}

void PassEvaluation::skipFrame(Stamp stamp, const std::string& text) {
  keepNote(text);
  Entry& entry = entryAt(stamp);
  if (entry.record.state != FrameState::kWaiting) {
    return;
  }
  images_alone_.erase(stamp);
  images_doubted_.erase(stamp);
  held_.erase(stamp);
  entry.lines.reset();
  entry.ground_truth.reset();
  setState(&entry, FrameState::kSkipped);
}

}  // namespace evolin
