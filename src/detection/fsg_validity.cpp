// Rectangles around groups, and the chance of their segments.
#include "fsg_validity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evolin::fsg {
namespace {

double arcSine(double value) { return std::asin(std::clamp(value, -1.0, 1.0)); }

double root(double value) { return std::sqrt(std::max(0.0, value)); }

/// Integral of asin((w + x) / l) + asin((w - x) / l) over x, up to a constant.
double bothSides(double x, double w, double l) {
  return (x + w) * arcSine((x + w) / l) - (x - w) * arcSine((x - w) / l) +
         root(l * l - (x + w) * (x + w)) - root(l * l - (x - w) * (x - w));
}

/// The same where the first of them is a right angle.
double oneSide(double x, double w, double l) {
  return -(x - w) * arcSine((x - w) / l) - root(l * l - (x - w) * (x - w)) + CV_PI * x / 2;
}

}  // namespace

double insideStrip(double width, double length) {
  const double w = width;
  const double l = length;
  if (l > 2 * w) {
    return (bothSides(w, w, l) - bothSides(0, w, l)) / CV_PI;
  }
  if (l >= w) {
    return (bothSides(l - w, w, l) - bothSides(0, w, l) + oneSide(w, w, l) - oneSide(l - w, w, l)) /
           CV_PI;
  }
  return (CV_PI * (w - l) + oneSide(w, w, l) - oneSide(w - l, w, l)) / CV_PI;
}

Validity::Validity(cv::Size size, double segment_density)
    : size_(size), segments_(std::floor(static_cast<double>(size.area()) / segment_density)) {}

double Validity::logGroups(std::size_t members) {
  if (log_groups_.empty()) {
    log_groups_.push_back(0);
  }
  while (log_groups_.size() <= members) {
    const auto k = static_cast<double>(log_groups_.size());
    const double left = segments_ - k + 1;
    // More than there are cannot be chosen: no number of tests speaks against them.
    log_groups_.push_back(left > 0 ? log_groups_.back() + std::log(left / k)
                                   : -std::numeric_limits<double>::infinity());
  }
  return log_groups_[members];
}

double Validity::logNfa(const std::vector<Segment>& members, const Segment& candidate) {
  const double dx = candidate.b.x - candidate.a.x;
  const double dy = candidate.b.y - candidate.a.y;
  const double norm = std::hypot(dx, dy);
  const double cosine = dx / norm;
  const double sine = dy / norm;
  double along_low = std::numeric_limits<double>::max();
  double along_high = -along_low;
  double across_low = along_low;
  double across_high = -along_low;
  const auto include = [&](const Segment& segment) {
    for (const cv::Point2f& p : {segment.a, segment.b}) {
      const double along = cosine * p.x + sine * p.y;
      const double across = -sine * p.x + cosine * p.y;
      along_low = std::min(along_low, along);
      along_high = std::max(along_high, along);
      across_low = std::min(across_low, across);
      across_high = std::max(across_high, across);
    }
  };
  include(candidate);
  for (const Segment& member : members) include(member);
  const double width = across_high - across_low;
  const double area = width * (along_high - along_low);
  if (!(area > 0)) {
    return std::numeric_limits<double>::lowest();
  }
  const std::size_t count = members.size() + 1;
  double chance = std::log(insideStrip(width, candidate.length));
  for (const Segment& member : members) chance += std::log(insideStrip(width, member.length));
  return logGroups(count) +
         static_cast<double>(count) * std::log(area / static_cast<double>(size_.area())) + chance;
}

}  // namespace evolin::fsg
