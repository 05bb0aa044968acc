// A frame's figures without what all frames share.
#include "evolin_ros/evaluation/frame_figures.h"

#include <cmath>
#include <limits>

namespace evolin {

void FrameFigures::keepDetection(FrameRecord* record) {
  detection_.clear();
  detection_.reserve(record->entries.size());
  for (const DetectionEntry& entry : record->entries) {
    detection_.push_back(
        {entry.average_precision.value_or(std::numeric_limits<double>::quiet_NaN()),
         static_cast<std::uint32_t>(entry.counts.true_positives),
         static_cast<std::uint32_t>(entry.counts.predicted)});
    ground_truth_ = static_cast<std::uint32_t>(entry.counts.ground_truth);
  }
  record->entries = std::vector<DetectionEntry>();
}

void FrameFigures::keepHeatmap(const std::vector<Classification>& counts) {
  heatmap_.clear();
  heatmap_.reserve(counts.size());
  for (const Classification& each : counts) {
    heatmap_.push_back({static_cast<std::uint32_t>(each.true_positives),
                        static_cast<std::uint32_t>(each.predicted)});
    ground_truth_pixels_ = static_cast<std::uint32_t>(each.ground_truth);
  }
}

void FrameFigures::restore(const std::vector<VectorizedSetting>& settings,
                           FrameRecord* record) const {
  record->entries.clear();
  record->entries.reserve(detection_.size());
  for (std::size_t i = 0; i < detection_.size(); ++i) {
    const Detection& kept = detection_[i];
    DetectionEntry entry;
    entry.setting = settings.at(i);
    entry.counts = {kept.true_positives, kept.predicted, ground_truth_};
    if (!std::isnan(kept.average_precision)) {
      entry.average_precision = kept.average_precision;
    }
    record->entries.push_back(entry);
  }
  record->heatmap.clear();
  record->heatmap.reserve(heatmap_.size());
  for (const Pixels& kept : heatmap_) {
    record->heatmap.push_back({kept.true_positives, kept.predicted, ground_truth_pixels_});
  }
}

}  // namespace evolin
