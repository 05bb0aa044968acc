// Exhaustive and row by row: frames that people look at have few lines.
#include "evolin_ros/metrics/line_verdicts.h"

#include <cstdint>
#include <limits>
#include <optional>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/clipping.h"
#include "evolin_ros/geometry/distance.h"
#include "scaling.h"

namespace evolin {

namespace {

bool isPoint(const LineSegment& line) { return line.x1 == line.x2 && line.y1 == line.y2; }

void requireFinite(const std::string& kind, std::size_t row, const LineSegment& line) {
  if (!line.isFinite()) {
    throw Error(kind + " line " + std::to_string(row) + ": " + coordinates(line) +
                " is not finite");
  }
}

/// As it is compared; none where the protocol drops it.
std::optional<LineSegment> prepared(const LineSegment& line, ImageSize size, Protocol protocol) {
  if (protocol == Protocol::kEvolin) {
    const LineSegment clamped =
        clampToRectangle(scaled(line, size), {0, 0, kScaledSide - 1, kScaledSide - 1});
    const bool dropped = clamped.x1 == clamped.x2 || clamped.y1 == clamped.y2;
    return dropped ? std::nullopt : std::optional<LineSegment>(clamped);
  }
  const std::optional<LineSegment> clipped =
      clipToRectangle(scaled(line, size), {0, 0, kScaledSide, kScaledSide});
  return clipped && isPoint(*clipped) ? std::nullopt : clipped;
}

double distanceOf(LineDistance kind, Protocol protocol, const LineSegment& a,
                  const LineSegment& b) {
  return kind == LineDistance::kStructural
             ? structuralDistance(a, b)
             : orthogonalDistance(a, b, protocol == Protocol::kEvolin);
}

}  // namespace

LineVerdicts judgeLines(const VectorizedSetting& setting, Protocol protocol, ImageSize size,
                        const LineSegments& predicted, const LineSegments& ground_truth,
                        bool scored) {
  if (size.width <= 0 || size.height <= 0) {
    throw Error("verdicts on lines of an image of " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + "; expected a positive number of pixels");
  }
  LineSegments truth;
  for (std::size_t row = 0; row < ground_truth.size(); ++row) {
    requireFinite("ground-truth", row, ground_truth[row]);
    truth.push_back(scaled(ground_truth[row], size));
    if (isPoint(truth.back())) {
      throw Error("ground-truth line " + std::to_string(row) + " has no length");
    }
  }
  struct Claim {
    std::size_t row = 0;
    double distance = 0;
  };
  LineVerdicts verdicts;
  verdicts.predicted.assign(predicted.size(), LineVerdict::kFalsePositive);
  std::vector<std::optional<Claim>> best(truth.size());
  for (std::size_t row = 0; row < predicted.size(); ++row) {
    requireFinite("predicted", row, predicted[row]);
    const std::optional<LineSegment> line = prepared(predicted[row], size, protocol);
    if (!line) {
      verdicts.predicted[row] = LineVerdict::kDropped;
      continue;
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t target = truth.size();
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double distance = distanceOf(setting.distance, protocol, *line, truth[i]);
      if (distance < nearest) {
        nearest = distance;
        target = i;
      }
    }
    const bool near_enough =
        protocol == Protocol::kEvolin ? nearest < setting.threshold : nearest <= setting.threshold;
    if (target == truth.size() || !near_enough) {
      continue;
    }
    std::optional<Claim>& holder = best[target];
    if (!holder || (scored ? predicted[row].score > predicted[holder->row].score
                           : nearest < holder->distance)) {
      holder = Claim{row, nearest};
    }
  }
  for (const std::optional<Claim>& claim : best) {
    verdicts.found.push_back(claim.has_value());
    if (claim) {
      verdicts.predicted[claim->row] = LineVerdict::kTruePositive;
    }
  }
  return verdicts;
}

}  // namespace evolin
