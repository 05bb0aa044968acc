// A 2-D line segment in pixels and the few things one asks of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace evolin {

constexpr double kNoScore = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kNoId = -1;

/// Endpoints in pixels: x right, y down, the centre of the top-left pixel is (0, 0). `score` grows
/// with quality (NaN: none); `id` names the physical line or the track (-1: none).
struct LineSegment {
  double x1 = 0;
  double y1 = 0;
  double x2 = 0;
  double y2 = 0;
  double score = kNoScore;
  std::int64_t id = kNoId;

  double length() const { return std::hypot(x2 - x1, y2 - y1); }
  bool hasScore() const { return !std::isnan(score); }
  bool isFinite() const {
    return std::isfinite(x1) && std::isfinite(y1) && std::isfinite(x2) && std::isfinite(y2);
  }
};

using LineSegments = std::vector<LineSegment>;

/// Indices of two matched lines, the first in the earlier frame; `distance` in the matcher's own
/// unit (NaN: none).
struct LineMatch {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  float distance = std::numeric_limits<float>::quiet_NaN();
};

using LineMatches = std::vector<LineMatch>;

/// Bare pairs of line indices, as the association files hold them.
using IndexPair = std::pair<std::int64_t, std::int64_t>;
using IndexPairs = std::vector<IndexPair>;

}  // namespace evolin
