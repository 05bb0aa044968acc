// A line's neighbourhood is convex, so another line is inside it over one stretch.
#include "twin_lines.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace evolin::synthetic {

namespace {

constexpr EdgePart kNothing{1, 0};

EdgePart hull(const EdgePart& a, const EdgePart& b) {
  if (a.begin >= a.end) {
    return b;
  }
  return b.begin >= b.end ? a : EdgePart{std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Where low <= at + s slope <= high, within [0, 1].
EdgePart between(double at, double slope, double low, double high) {
  if (slope == 0) {
    return at >= low && at <= high ? EdgePart() : kNothing;
  }
  const double s = (low - at) / slope;
  const double t = (high - at) / slope;
  return {std::clamp(std::min(s, t), 0.0, 1.0), std::clamp(std::max(s, t), 0.0, 1.0)};
}

/// Where the line from (x, y), (dx, dy) long, is inside a circle around the origin.
EdgePart insideCircle(double x, double y, double dx, double dy, double radius) {
  const double square = dx * dx + dy * dy;
  const double middle = -(x * dx + y * dy) / square;
  const double across = x * dy - y * dx;
  const double half = radius * radius * square - across * across;
  if (half <= 0) {
    return kNothing;
  }
  const double reach = std::sqrt(half) / square;
  return {std::clamp(middle - reach, 0.0, 1.0), std::clamp(middle + reach, 0.0, 1.0)};
}

/// Share of the way in space, for a share of the way in the image.
double shareInSpace(const ProjectedPart& part, double share) {
  const double near = (1 - share) * part.depth2;
  const double far = share * part.depth1;
  return part.seen.begin + far / (near + far) * (part.seen.end - part.seen.begin);
}

VisibleLine cut(const ProjectedPart& part, const EdgePart& piece) {
  VisibleLine result;
  result.edge = part.edge;
  result.line = part.line;
  result.reach = part.exposed;
  const double dx = part.line.x2 - part.line.x1;
  const double dy = part.line.y2 - part.line.y1;
  if (piece.begin > 0) {
    result.line.x1 = part.line.x1 + piece.begin * dx;
    result.line.y1 = part.line.y1 + piece.begin * dy;
    result.reach.begin = shareInSpace(part, piece.begin);
  }
  if (piece.end < 1) {
    result.line.x2 = part.line.x1 + piece.end * dx;
    result.line.y2 = part.line.y1 + piece.end * dy;
    result.reach.end = shareInSpace(part, piece.end);
  }
  return result;
}

}  // namespace

std::vector<EdgePart> complement(const EdgePart& whole, std::vector<EdgePart> taken) {
  std::sort(taken.begin(), taken.end(),
            [](const EdgePart& a, const EdgePart& b) { return a.begin < b.begin; });
  std::vector<EdgePart> parts;
  double reached = whole.begin;
  for (const EdgePart& part : taken) {
    if (part.begin > reached) {
      parts.push_back({reached, part.begin});
    }
    reached = std::max(reached, part.end);
  }
  if (reached < whole.end) {
    parts.push_back({reached, whole.end});
  }
  return parts;
}

EdgePart stretchNear(const LineSegment& line, const LineSegment& other, double distance) {
  const double length = other.length();
  const double ux = (other.x2 - other.x1) / length;
  const double uy = (other.y2 - other.y1) / length;
  const double dx = line.x2 - line.x1;
  const double dy = line.y2 - line.y1;
  const double x = line.x1 - other.x1;
  const double y = line.y1 - other.y1;
  const EdgePart beside = between(x * ux + y * uy, dx * ux + dy * uy, 0, length);
  const EdgePart along = between(ux * y - uy * x, ux * dy - uy * dx, -distance, distance);
  const EdgePart middle{std::max(beside.begin, along.begin), std::min(beside.end, along.end)};
  const EdgePart ends =
      hull(insideCircle(x, y, dx, dy, distance),
           insideCircle(line.x1 - other.x2, line.y1 - other.y2, dx, dy, distance));
  return hull(middle, ends);
}

std::vector<VisibleLine> withoutTwins(std::vector<ProjectedPart> parts) {
  const auto key = [](const ProjectedPart& part) {
    return std::tuple(-part.line.length(), part.edge, part.seen.begin);
  };
  std::sort(parts.begin(), parts.end(),
            [&key](const ProjectedPart& a, const ProjectedPart& b) { return key(a) < key(b); });
  std::vector<VisibleLine> kept;
  for (const ProjectedPart& part : parts) {
    const double length = part.line.length();
    std::vector<EdgePart> taken;
    for (const VisibleLine& other : kept) {
      const EdgePart twin = stretchNear(part.line, other.line, kTwinDistance);
      if ((twin.end - twin.begin) * length >= kMinLength) {
        taken.push_back(twin);
      }
    }
    for (const EdgePart& piece : complement(EdgePart(), std::move(taken))) {
      const VisibleLine line = cut(part, piece);
      if (line.line.length() >= kMinLength) {
        kept.push_back(line);
      }
    }
  }
  std::sort(kept.begin(), kept.end(), [](const VisibleLine& a, const VisibleLine& b) {
    return std::tie(a.edge, a.reach.begin) < std::tie(b.edge, b.reach.begin);
  });
  return kept;
}

}  // namespace evolin::synthetic
