// Choosing entries of the metric messages and writing them with units.
#include "view_numbers.h"

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

namespace evolin::ros_shell {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::string text(double value, int digits, const std::string& unit) {
  if (!std::isfinite(value)) {
    return std::isinf(value) ? "inf" : "-";
  }
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(digits) << value << unit;
  return out.str();
}

std::string percent(double ratio) { return text(100 * ratio, 1, " %"); }

std::string counted(std::size_t count, const std::string& what) {
  return ", " + std::to_string(count) + " " + what;
}

/// The structural entry at the threshold, before others that differ in something else.
template <class Entries>
const typename Entries::value_type* structuralEntry(const Entries& entries, double threshold) {
  for (const auto& entry : entries) {
    if (entry.distance == "structural" && entry.threshold == threshold) {
      return &entry;
    }
  }
  return nullptr;
}

}  // namespace

bool ViewNumbers::take(const evolin_ros::DetectionMetrics& message) {
  const bool anew = detection_ && message.frames < detection_->frames;
  detection_ = message;
  return anew;
}

ViewSection ViewNumbers::detection() const {
  const auto* const entry = detection_ ? structuralEntry(detection_->entries, threshold_) : nullptr;
  const bool heatmap = heatmap_ && heatmap_->frames > 0 && !heatmap_->entries.empty();
  // Before the first frame ratios are 0 by convention, which would read as a result.
  const bool defined = entry != nullptr && detection_->frames > 0;
  return {"detection" + (detection_ ? counted(detection_->frames, "frames") : ""),
          {{"precision", percent(defined ? entry->precision : kNothing)},
           {"recall", percent(defined ? entry->recall : kNothing)},
           {"F-score", percent(defined ? entry->f_score : kNothing)},
           {"average precision", percent(defined ? entry->average_precision : kNothing)},
           {"F-score on pixels", percent(heatmap ? heatmap_->entries.back().f_score : kNothing)}}};
}

ViewSection ViewNumbers::repeatability() const {
  const auto* const entry =
      repeatability_ ? structuralEntry(repeatability_->entries, threshold_) : nullptr;
  return {"repeatability" + (entry != nullptr ? ", step " + std::to_string(entry->step) +
                                                    counted(repeatability_->frames, "pairs")
                                              : ""),
          {{"found again", percent(entry != nullptr ? entry->repeatability : kNothing)},
           {"localisation error",
            text(entry != nullptr ? entry->localization_error : kNothing, 2, " px")}}};
}

ViewSection ViewNumbers::association() const {
  const bool detected = detected_ && detected_->frames > (association_ ? association_->frames : 0);
  const auto& shown = detected ? detected_ : association_;
  const bool defined = shown && shown->frames > 0 && !shown->entries.empty();
  return {std::string("matches") + (detected ? " (detected)" : "") +
              (shown ? counted(shown->frames, "pairs") : ""),
          {{"precision", percent(defined ? shown->entries[0].precision : kNothing)},
           {"recall", percent(defined ? shown->entries[0].recall : kNothing)},
           {"F-score", percent(defined ? shown->entries[0].f_score : kNothing)}}};
}

ViewSection ViewNumbers::pose() const {
  return {"relative pose" + (pose_ ? counted(pose_->pairs, "pairs") : ""),
          {{"rotation, median", text(pose_ ? pose_->rotation_median : kNothing, 2, " deg")},
           {"translation, median", text(pose_ ? pose_->translation_median : kNothing, 3, " m")},
           {"within 1 deg, 5 cm", percent(pose_ ? pose_->success_rate : kNothing)}}};
}

std::vector<ViewSection> ViewNumbers::sections(std::size_t unpaired) const {
  const std::string evaluated =
      coverage_ ? std::to_string(coverage_->evaluated) + " of " + std::to_string(coverage_->seen)
                : "-";
  return {detection(),
          repeatability(),
          association(),
          pose(),
          {"coverage",
           {{"frames evaluated", evaluated}, {"parts not shown", std::to_string(unpaired)}}}};
}

}  // namespace evolin::ros_shell
