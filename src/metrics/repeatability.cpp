// Projections of both frames of a pair against the other's lines, for every setting at once.
#include "evolin_ros/metrics/repeatability.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "nearest_line.h"
#include "scaling.h"

namespace evolin {

namespace {

void checkOptions(const RepeatabilityOptions& options) {
  if (options.distances.empty() || options.distance_thresholds.empty() ||
      options.frame_steps.empty()) {
    throw Error("repeatability: " + std::to_string(options.distances.size()) + " distances, " +
                std::to_string(options.distance_thresholds.size()) + " distance thresholds, " +
                std::to_string(options.frame_steps.size()) +
                " frame steps; expected one or more of each");
  }
  for (const double threshold : options.distance_thresholds) {
    if (!(threshold > 0) || !std::isfinite(threshold)) {
      throw Error("distance threshold " + formatDouble(threshold) +
                  ": expected a positive, finite number of pixels");
    }
  }
  for (const double threshold : options.score_thresholds) {
    if (std::isnan(threshold)) {
      throw Error("score threshold nan: expected a number");
    }
  }
  for (auto step = options.frame_steps.begin(); step != options.frame_steps.end(); ++step) {
    if (*step < 1) {
      throw Error("frame step " + std::to_string(*step) + ": expected 1 or more");
    }
    if (std::find(options.frame_steps.begin(), step, *step) != step) {
      throw Error("frame step " + std::to_string(*step) + " occurs twice: expected each step once");
    }
  }
}

void requireScores(const SpatialFrame& frame) {
  for (std::size_t row = 0; row < frame.lines.size(); ++row) {
    if (!frame.lines[row].segment.hasScore()) {
      throw Error("detected lines, row " + std::to_string(row) +
                  ": no score; expected one for every line, as there are score thresholds");
    }
  }
}

std::size_t countAbove(const SpatialFrame& frame, double threshold) {
  return static_cast<std::size_t>(std::count_if(
      frame.lines.begin(), frame.lines.end(),
      [threshold](const SpatialLine& line) { return line.segment.score > threshold; }));
}

LineSegments keepAbove(const LineSegments& lines, double threshold) {
  LineSegments kept;
  kept.reserve(lines.size());
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(kept),
               [threshold](const LineSegment& line) { return line.score > threshold; });
  return kept;
}

double longestReach(const RepeatabilityOptions& options) {
  return *std::max_element(options.distance_thresholds.begin(), options.distance_thresholds.end());
}

/// One sum a threshold, of the distances to the nearest lines.
void appendRedetections(const std::vector<double>& nearest, const RepeatabilityOptions& options,
                        std::vector<Redetections>* result) {
  for (const double threshold : options.distance_thresholds) {
    Redetections found;
    ExactSum sum;  // of distances in any order of rows
    for (const double value : nearest) {
      if (options.protocol == Protocol::kEvolin ? value < threshold : value <= threshold) {
        ++found.count;
        sum.add(value);
      }
    }
    found.distance_sum = sum.value();
    result->push_back(found);
  }
}

/// One sum a setting of a step, distance slowest.
std::vector<Redetections> findRedetections(const RepeatabilityOptions& options,
                                           ProjectedLines* projected) {
  if (options.distances.size() > 1) {
    projected->searchBoth(longestReach(options));
  }
  std::vector<Redetections> result;
  for (const LineDistance distance : options.distances) {
    appendRedetections(projected->nearestDistances(distance, longestReach(options)), options,
                       &result);
  }
  return result;
}

/// The same of the lines with score > threshold alone.
std::vector<Redetections> findRedetectionsAbove(double threshold,
                                                const RepeatabilityOptions& options,
                                                ProjectedLines* projected) {
  const LineSegments projections = keepAbove(projected->scaledProjections(), threshold);
  NearestLineSearch search(keepAbove(scaledLines(projected->to()), threshold));
  const double reach = longestReach(options);
  const bool gate = options.protocol == Protocol::kEvolin;
  std::vector<Redetections> result;
  std::vector<double> nearest(projections.size());
  for (const LineDistance distance : options.distances) {
    std::transform(projections.begin(), projections.end(), nearest.begin(),
                   [&](const LineSegment& projection) {
                     return search.find(distance, projection, reach, gate).distance;
                   });
    appendRedetections(nearest, options, &result);
  }
  return result;
}

}  // namespace

double PairRepeatability::repeatability() const {
  const double found = static_cast<double>(forward.count) + backward.count;
  return lines == 0 ? 0.0 : found / lines;
}

double PairRepeatability::localizationError(Protocol protocol) const {
  if (protocol == Protocol::kEvolin) {
    return (forward.meanDistance() + backward.meanDistance()) / 2;
  }
  const double count = static_cast<double>(forward.count) + backward.count;
  return count == 0 ? 0.0 : (forward.distance_sum + backward.distance_sum) / count;
}

void RepeatabilitySum::add(const PairRepeatability& pair, Protocol protocol) {
  ++pairs_;
  redetections_ += std::uint64_t{pair.forward.count} + pair.backward.count;
  repeatability_.add(pair.repeatability());
  if (protocol == Protocol::kEvolin) {
    localization_error_.add(pair.localizationError(protocol));
  } else {
    localization_error_.add(pair.forward.distance_sum);
    localization_error_.add(pair.backward.distance_sum);
  }
}

RepeatabilitySum& RepeatabilitySum::operator+=(const RepeatabilitySum& other) {
  pairs_ += other.pairs_;
  redetections_ += other.redetections_;
  repeatability_ += other.repeatability_;
  localization_error_ += other.localization_error_;
  return *this;
}

std::optional<RepeatabilityFigures> RepeatabilitySum::figures(Protocol protocol) const {
  if (pairs_ == 0) {
    return std::nullopt;
  }
  const std::uint64_t parts = protocol == Protocol::kEvolin ? pairs_ : redetections_;
  return RepeatabilityFigures{
      repeatability_.value() / static_cast<double>(pairs_),
      parts == 0 ? 0.0 : localization_error_.value() / static_cast<double>(parts)};
}

RepeatabilityMetrics::RepeatabilityMetrics(RepeatabilityOptions options)
    : options_(std::move(options)) {
  checkOptions(options_);
  std::vector<std::optional<double>> scores(options_.score_thresholds.begin(),
                                            options_.score_thresholds.end());
  if (scores.empty()) {
    scores.emplace_back();
  }
  for (const std::optional<double>& score : scores) {
    for (const LineDistance distance : options_.distances) {
      for (const double threshold : options_.distance_thresholds) {
        for (const int step : options_.frame_steps) {
          settings_.push_back({score, distance, threshold, step});
        }
      }
    }
  }
  sums_.resize(settings_.size());
}

std::size_t RepeatabilityMetrics::stepIndex(int frame_step) const {
  const std::vector<int>& steps = options_.frame_steps;
  const auto found = std::find(steps.begin(), steps.end(), frame_step);
  if (found == steps.end()) {
    throw Error("frame step " + std::to_string(frame_step) +
                ": expected one of the steps that the metric was made for");
  }
  return static_cast<std::size_t>(found - steps.begin());
}

std::vector<std::size_t> RepeatabilityMetrics::settingsOf(int frame_step) const {
  std::vector<std::size_t> result;
  for (std::size_t index = stepIndex(frame_step); index < settings_.size();
       index += options_.frame_steps.size()) {
    result.push_back(index);
  }
  return result;
}

void RepeatabilityMetrics::checkFrames(const SpatialFrame& first,
                                       const SpatialFrame& second) const {
  if (first.protocol != options_.protocol) {
    throw Error("frame lifted under protocol " + toString(first.protocol) + ": expected " +
                toString(options_.protocol));
  }
  if (!options_.score_thresholds.empty()) {
    requireScores(first);
    requireScores(second);
  }
}

std::vector<PairRepeatability> RepeatabilityMetrics::measure(const SpatialFrame& first,
                                                             const SpatialFrame& second) const {
  checkFrames(first, second);
  const std::vector<double>& scores = options_.score_thresholds;
  ProjectedPair pair(first, second,
                     scores.empty() ? kNoScore : *std::min_element(scores.begin(), scores.end()));
  return measure(&pair);
}

std::vector<PairRepeatability> RepeatabilityMetrics::measure(ProjectedPair* pair) const {
  const SpatialFrame& first = pair->forward.from();
  const SpatialFrame& second = pair->forward.to();
  checkFrames(first, second);
  std::vector<PairRepeatability> result;
  const auto append = [&result](std::size_t lines, const std::vector<Redetections>& there,
                                const std::vector<Redetections>& back) {
    for (std::size_t index = 0; index < there.size(); ++index) {
      result.push_back({static_cast<std::uint32_t>(lines), there[index], back[index]});
    }
  };
  if (options_.score_thresholds.empty()) {
    append(first.lines.size() + second.lines.size(), findRedetections(options_, &pair->forward),
           findRedetections(options_, &pair->backward));
  }
  for (const double threshold : options_.score_thresholds) {
    append(countAbove(first, threshold) + countAbove(second, threshold),
           findRedetectionsAbove(threshold, options_, &pair->forward),
           findRedetectionsAbove(threshold, options_, &pair->backward));
  }
  return result;
}

void RepeatabilityMetrics::add(int frame_step, const std::vector<PairRepeatability>& pair) {
  const std::vector<std::size_t> settings = settingsOf(frame_step);
  if (pair.size() != settings.size()) {
    throw Error("repeatability of a pair: " + std::to_string(pair.size()) +
                " results; expected one for each of " + std::to_string(settings.size()) +
                " settings");
  }
  for (std::size_t index = 0; index < settings.size(); ++index) {
    sums_[settings[index]].add(pair[index], options_.protocol);
  }
}

std::vector<PairRepeatability> RepeatabilityMetrics::addPair(int frame_step,
                                                             const SpatialFrame& first,
                                                             const SpatialFrame& second) {
  stepIndex(frame_step);  // refuses an unknown step before the work
  std::vector<PairRepeatability> pair = measure(first, second);
  add(frame_step, pair);
  return pair;
}

std::vector<PairRepeatability> RepeatabilityMetrics::addPair(int frame_step, ProjectedPair* pair) {
  stepIndex(frame_step);
  std::vector<PairRepeatability> results = measure(pair);
  add(frame_step, results);
  return results;
}

std::size_t RepeatabilityMetrics::pairs(int frame_step) const {
  return sums_[stepIndex(frame_step)].pairs();
}

std::optional<RepeatabilityFigures> RepeatabilityMetrics::figures(std::size_t setting) const {
  return sums_.at(setting).figures(options_.protocol);
}

void RepeatabilityMetrics::merge(const RepeatabilityMetrics& other) {
  if (options_.protocol != other.options_.protocol ||
      options_.distances != other.options_.distances ||
      options_.distance_thresholds != other.options_.distance_thresholds ||
      options_.frame_steps != other.options_.frame_steps ||
      options_.score_thresholds != other.options_.score_thresholds) {
    throw Error(
        "cannot merge repeatability metrics: protocols, distances, thresholds or steps differ");
  }
  for (std::size_t index = 0; index < sums_.size(); ++index) {
    sums_[index] += other.sums_[index];
  }
}

void RepeatabilityMetrics::reset() { sums_.assign(settings_.size(), RepeatabilitySum()); }

}  // namespace evolin
