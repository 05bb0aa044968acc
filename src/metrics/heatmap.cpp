// Drawing lines by falling score, counting pixels, and adding up.
#include "evolin_ros/metrics/heatmap.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "evolin_ros/base/deadline.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/metrics/pixel_matching.h"
#include "evolin_ros/metrics/rasterization.h"

namespace evolin {

namespace {

/// A greater reach than pixel matching takes; far beyond any camera.
constexpr double kMaxDiagonal = 25500;

std::string coordinates(const LineSegment& line) {
  return formatDouble(line.x1) + "," + formatDouble(line.y1) + "," + formatDouble(line.x2) + "," +
         formatDouble(line.y2);
}

void checkFrame(const std::string& name, ImageSize size, const LineSegments& predicted,
                const LineSegments& ground_truth, bool with_scores) {
  if (size.width <= 0 || size.height <= 0 || std::hypot(size.width, size.height) > kMaxDiagonal) {
    throw Error("image of frame " + name + ": size " + std::to_string(size.width) + " x " +
                std::to_string(size.height) +
                "; expected a positive number of pixels and a diagonal of at most " +
                formatDouble(kMaxDiagonal));
  }
  for (std::size_t row = 0; row < ground_truth.size(); ++row) {
    if (!ground_truth[row].isFinite()) {
      throw GroundTruthError(name, row, coordinates(ground_truth[row]) + " is not finite");
    }
  }
  for (std::size_t row = 0; row < predicted.size(); ++row) {
    const std::string where = "predicted lines of frame " + name + ", row " + std::to_string(row);
    if (!predicted[row].isFinite()) {
      throw Error(where + ": " + coordinates(predicted[row]) + " is not finite");
    }
    if (with_scores && !predicted[row].hasScore()) {
      throw Error(where + ": no score; expected a score for every line");
    }
  }
}

/// Draws lines of one image, each pixel in the first picture that asks for it.
class Canvas {
 public:
  explicit Canvas(ImageSize size)
      : size_(size),
        drawn_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)) {}

  /// Appends the pixels of `line` that were not drawn before.
  void draw(const LineSegment& line, Pixels* pixels) {
    const std::size_t begin = pixels->size();
    rasterize(line, size_, pixels);
    const auto known = [this](const Pixel& pixel) {
      const std::size_t index = static_cast<std::size_t>(pixel.y) * size_.width + pixel.x;
      const bool before = drawn_[index];
      drawn_[index] = true;
      return before;
    };
    pixels->erase(
        std::remove_if(pixels->begin() + static_cast<std::ptrdiff_t>(begin), pixels->end(), known),
        pixels->end());
  }

 private:
  ImageSize size_;
  std::vector<bool> drawn_;
};

}  // namespace

PrecisionRecallCurve heatmapCurve(const std::vector<Classification>& counts) {
  PrecisionRecallCurve curve;
  for (const Classification& each : counts) {
    curve.recall.push_back(each.recall());
    curve.precision.push_back(each.precision());
  }
  return curve;
}

HeatmapSummary summarizeHeatmap(const std::vector<Classification>& counts) {
  const PrecisionRecallCurve curve = heatmapCurve(counts);
  HeatmapSummary summary;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    summary.max_f_score = std::max(summary.max_f_score, counts[i].fScore());
    if (i > 0) {
      summary.average_precision += (curve.recall[i] - curve.recall[i - 1]) *
                                   (curve.precision[i] + curve.precision[i - 1]) / 2;
    }
  }
  return summary;
}

HeatmapMetrics::HeatmapMetrics(HeatmapOptions options)
    : thresholds_(std::move(options.score_thresholds)),
      frame_budget_(options.frame_budget),
      stop_(options.stop) {
  for (const double threshold : thresholds_) {
    if (std::isnan(threshold)) {
      throw Error("score threshold nan: expected a number");
    }
  }
  if (!(frame_budget_ > 0)) {
    throw Error("budget of a frame " + formatDouble(frame_budget_) +
                ": expected a positive number of seconds");
  }
  std::sort(thresholds_.begin(), thresholds_.end(), std::greater<>());
  sums_.resize(std::max<std::size_t>(thresholds_.size(), 1));
}

HeatmapMetrics::Frame HeatmapMetrics::measure(std::uint32_t frame_number,
                                              const std::string& frame_name, ImageSize size,
                                              const LineSegments& predicted,
                                              const LineSegments& ground_truth) const {
  Deadline deadline = Deadline::after(frame_budget_);
  deadline.stopOn(stop_);
  checkFrame(frame_name, size, predicted, ground_truth, !thresholds_.empty());
  Pixels truth;
  Canvas truth_canvas(size);
  for (const LineSegment& line : ground_truth) {
    deadline.check();
    truth_canvas.draw(line, &truth);
  }
  // A line shows up at the highest threshold below its score, and at all that follow.
  std::vector<std::vector<const LineSegment*>> shown(settings());
  for (const LineSegment& line : predicted) {
    const auto first =
        thresholds_.empty()
            ? thresholds_.begin()
            : std::find_if(thresholds_.begin(), thresholds_.end(),
                           [&line](double threshold) { return line.score > threshold; });
    const auto setting = static_cast<std::size_t>(first - thresholds_.begin());
    if (setting < settings()) {
      shown[setting].push_back(&line);
    }
  }
  std::vector<Pixels> added(settings());
  Canvas canvas(size);
  for (std::size_t setting = 0; setting < settings(); ++setting) {
    for (const LineSegment* line : shown[setting]) {
      deadline.check();
      canvas.draw(*line, &added[setting]);
    }
  }
  const std::vector<std::size_t> matched =
      countMatchedPixels(size, pixelMatchingRule(size), truth, added, deadline);
  Frame frame{frame_number, static_cast<std::uint32_t>(truth.size()), {}};
  std::uint32_t drawn = 0;
  for (std::size_t setting = 0; setting < settings(); ++setting) {
    drawn += static_cast<std::uint32_t>(added[setting].size());
    frame.counts.push_back({static_cast<std::uint32_t>(matched[setting]), drawn});
  }
  return frame;
}

HeatmapOutcome HeatmapMetrics::addFrame(std::uint32_t frame_number, const std::string& frame_name,
                                        ImageSize size, const LineSegments& predicted,
                                        const LineSegments& ground_truth) {
  const auto place = std::lower_bound(
      frames_.begin(), frames_.end(), frame_number,
      [](const Frame& frame, std::uint32_t value) { return frame.number < value; });
  if (place != frames_.end() && place->number == frame_number) {
    throw Error("frame " + frame_name + ": its number " + std::to_string(frame_number) +
                " is taken; expected every frame once");
  }
  try {
    Frame frame = measure(frame_number, frame_name, size, predicted, ground_truth);
    addToSums(*frames_.insert(place, std::move(frame)));
    return HeatmapOutcome::kAdded;
  } catch (const DeadlineError&) {
    const bool stopped = stop_ != nullptr && *stop_;
    return stopped ? HeatmapOutcome::kStopped : HeatmapOutcome::kOverBudget;
  }
}

Classification HeatmapMetrics::classificationOf(const Frame& frame, std::size_t setting) {
  const PixelCounts& counts = frame.counts.at(setting);
  return {counts.true_positives, counts.predicted, frame.ground_truth};
}

void HeatmapMetrics::addToSums(const Frame& frame) {
  for (std::size_t setting = 0; setting < settings(); ++setting) {
    sums_[setting] += classificationOf(frame, setting);
  }
}

std::vector<Classification> HeatmapMetrics::frameClassifications(std::size_t setting) const {
  std::vector<Classification> counts;
  counts.reserve(frames_.size());
  for (const Frame& frame : frames_) {
    counts.push_back(classificationOf(frame, setting));
  }
  return counts;
}

PrecisionRecallCurve HeatmapMetrics::curve() const {
  return thresholds_.empty() ? PrecisionRecallCurve() : heatmapCurve(sums_);
}

HeatmapSummary HeatmapMetrics::summary() const {
  return thresholds_.empty() ? HeatmapSummary() : summarizeHeatmap(sums_);
}

void HeatmapMetrics::merge(const HeatmapMetrics& other) {
  if (thresholds_ != other.thresholds_) {
    throw Error("cannot merge heatmap metrics: score thresholds differ");
  }
  if (!frames_.empty() && !other.frames_.empty() &&
      frames_.back().number < other.frames_.front().number) {
    // The way of a live stream: its cost must not grow with the frames already there.
    frames_.insert(frames_.end(), other.frames_.begin(), other.frames_.end());
  } else {
    mergeFrames(other.frames_);
  }
  for (std::size_t setting = 0; setting < settings(); ++setting) {
    sums_[setting] += other.sums_[setting];
  }
}

void HeatmapMetrics::mergeFrames(const std::vector<Frame>& others) {
  std::vector<Frame> frames;
  frames.reserve(frames_.size() + others.size());
  std::merge(frames_.begin(), frames_.end(), others.begin(), others.end(),
             std::back_inserter(frames),
             [](const Frame& a, const Frame& b) { return a.number < b.number; });
  const auto twice =
      std::adjacent_find(frames.begin(), frames.end(),
                         [](const Frame& a, const Frame& b) { return a.number == b.number; });
  if (twice != frames.end()) {
    throw Error("cannot merge heatmap metrics: frame number " + std::to_string(twice->number) +
                " occurs in both");
  }
  frames_ = std::move(frames);
}

void HeatmapMetrics::reset() {
  frames_.clear();
  std::fill(sums_.begin(), sums_.end(), Classification());
}

}  // namespace evolin
