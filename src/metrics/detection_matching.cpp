// The nearest ground-truth line of every prediction, and the best prediction of every such line.
#include "detection_matching.h"

#include <algorithm>
#include <optional>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/clipping.h"
#include "nearest_line.h"
#include "scaling.h"

namespace evolin {

namespace {

/// For every ground-truth row the best prediction among those that went to it and are near enough.
void chooseBest(const LineSegments& predictions, const std::vector<NearestLine>& nearest,
                double threshold, bool scored, Protocol protocol, std::vector<std::int64_t>* best) {
  std::fill(best->begin(), best->end(), -1);
  for (std::size_t index = 0; index < predictions.size(); ++index) {
    const NearestLine& found = nearest[index];
    const bool near_enough =
        protocol == Protocol::kEvolin ? found.distance < threshold : found.distance <= threshold;
    if (!near_enough) {
      continue;
    }
    std::int64_t& holder = (*best)[found.row];
    if (holder < 0 || (scored ? predictions[index].score > predictions[holder].score
                              : found.distance < nearest[holder].distance)) {
      holder = static_cast<std::int64_t>(index);
    }
  }
}

}  // namespace

void checkSize(const std::string& frame, ImageSize size) {
  if (size.width <= 0 || size.height <= 0) {
    throw Error("image of frame " + frame + ": size " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + "; expected a positive number of pixels");
  }
}

LineSegments prepareGroundTruth(const std::string& frame, ImageSize size,
                                const LineSegments& lines) {
  // Annotations may touch the outer edge of the first pixels, whose centres are at 0.
  const double low_x = -0.5 * kScaledSide / size.width;
  const double low_y = -0.5 * kScaledSide / size.height;
  LineSegments result;
  result.reserve(lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    if (!line.isFinite()) {
      throw GroundTruthError(frame, row, coordinates(line) + " is not finite");
    }
    const LineSegment prepared = scaled(line, size);
    if (prepared.x1 == prepared.x2 && prepared.y1 == prepared.y2) {
      throw GroundTruthError(frame, row,
                             coordinates(line) + " has no length; expected two distinct endpoints");
    }
    if (std::max({prepared.x1, prepared.y1, prepared.x2, prepared.y2}) > kScaledSide ||
        std::min(prepared.x1, prepared.x2) < low_x || std::min(prepared.y1, prepared.y2) < low_y) {
      throw GroundTruthError(frame, row,
                             coordinates(line) + " leaves the image of " +
                                 std::to_string(size.width) + " x " + std::to_string(size.height) +
                                 " pixels");
    }
    result.push_back(prepared);
  }
  return result;
}

PreparedPredictions preparePredictions(const std::string& frame, ImageSize size,
                                       const LineSegments& lines, bool with_scores,
                                       Protocol protocol) {
  const Rectangle clamping{0, 0, kScaledSide - 1, kScaledSide - 1};
  const Rectangle clipping{0, 0, kScaledSide, kScaledSide};
  PreparedPredictions result;
  result.lines.reserve(lines.size());
  result.rows.reserve(lines.size());
  const auto keep = [&result](const LineSegment& line, std::size_t row) {
    result.lines.push_back(line);
    result.rows.push_back(static_cast<std::uint32_t>(row));
  };
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    if (!line.isFinite()) {
      throw Error("predicted lines of frame " + frame + ", row " + std::to_string(row) + ": " +
                  coordinates(line) + " is not finite");
    }
    if (with_scores && !line.hasScore()) {
      throw Error("predicted lines of frame " + frame + ", row " + std::to_string(row) +
                  ": no score; expected a score for every line or for none");
    }
    if (protocol == Protocol::kEvolin) {
      // The published rule drops every exactly horizontal or vertical line, not only points.
      const LineSegment clamped = clampToRectangle(scaled(line, size), clamping);
      if (clamped.x1 != clamped.x2 && clamped.y1 != clamped.y2) {
        keep(clamped, row);
      }
    } else {
      const std::optional<LineSegment> clipped = clipToRectangle(scaled(line, size), clipping);
      if (clipped && !(clipped->x1 == clipped->x2 && clipped->y1 == clipped->y2)) {
        keep(*clipped, row);
      }
    }
  }
  return result;
}

std::vector<std::uint32_t> findHits(const LineSegments& predictions,
                                    const LineSegments& ground_truth, bool scored,
                                    const VectorizedOptions& options) {
  const double reach =
      *std::max_element(options.distance_thresholds.begin(), options.distance_thresholds.end());
  const bool gate = options.protocol == Protocol::kEvolin;
  NearestLineSearch search(ground_truth);
  const bool both = options.distances.size() > 1;
  std::vector<NearestLines> found;
  if (both) {
    found.reserve(predictions.size());
    for (const LineSegment& prediction : predictions) {
      found.push_back(search.findBoth(prediction, reach, gate));
    }
  }
  std::vector<NearestLine> nearest(predictions.size());
  std::vector<std::int64_t> best(ground_truth.size());
  std::vector<std::uint32_t> hits(predictions.size(), 0);
  std::uint32_t bit = 1;
  for (const LineDistance distance : options.distances) {
    for (std::size_t index = 0; index < predictions.size(); ++index) {
      nearest[index] =
          both ? found[index].of(distance) : search.find(distance, predictions[index], reach, gate);
    }
    for (const double threshold : options.distance_thresholds) {
      chooseBest(predictions, nearest, threshold, scored, options.protocol, &best);
      for (const std::int64_t holder : best) {
        if (holder >= 0) {
          hits[holder] |= bit;
        }
      }
      bit <<= 1U;
    }
  }
  return hits;
}

std::vector<std::int64_t> findTakers(const LineSegments& predictions,
                                     const LineSegments& ground_truth, bool scored,
                                     const VectorizedSetting& setting, Protocol protocol) {
  NearestLineSearch search(ground_truth);
  std::vector<NearestLine> nearest;
  nearest.reserve(predictions.size());
  for (const LineSegment& line : predictions) {
    nearest.push_back(
        search.find(setting.distance, line, setting.threshold, protocol == Protocol::kEvolin));
  }
  std::vector<std::int64_t> best(ground_truth.size());
  chooseBest(predictions, nearest, setting.threshold, scored, protocol, &best);
  return best;
}

}  // namespace evolin
