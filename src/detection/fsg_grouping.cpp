// Order, candidates, cones, overlaps, and the incremental fit of groups.
#include "fsg_grouping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace evolin::fsg {
namespace {

constexpr float kShortest = 0.01F;  // of the image's mean side: shorter segments never group

float distance(cv::Point2f a, cv::Point2f b) {
  return static_cast<float>(std::sqrt(static_cast<double>((a - b).dot(a - b))));
}

cv::Point2f middle(const Segment& s) { return {(s.a.x + s.b.x) / 2, (s.a.y + s.b.y) / 2}; }

/// Share of `candidate` that lies beside `member`, by projection.
double overlap(const Segment& member, const Segment& candidate) {
  const cv::Point2f d = member.b - member.a;
  const auto along = [&](cv::Point2f p) {
    return static_cast<double>((p - member.a).dot(d)) / member.length;
  };
  const double one = along(candidate.a);
  const double other = along(candidate.b);
  const double low = std::min(one, other);
  const double high = std::max(one, other);
  const double length = member.length;
  if (high <= 0 || low >= length) {
    return 0;
  }
  if ((low >= 0) == (high <= length)) {
    return 1;  // within the member, or beyond both its ends
  }
  return low < 0 ? high / (high - low) : (length - low) / (high - low);
}

}  // namespace

/// The two lines from a segment's middle that touch the circles of the endpoint error around its
/// ends: what continues the segment lies between them.
struct Grouping::Cone {
  bool everywhere = false;  // the circles reach the middle
  cv::Point2f centre;
  cv::Point2f normal1;
  cv::Point2f normal2;

  Cone(const Segment& base, float radius) : centre(middle(base)) {
    const float half = base.length / 2;
    everywhere = half < radius;
    if (everywhere) {
      return;
    }
    const cv::Point2f u = (base.a - centre) * (1 / half);
    const cv::Point2f n(-u.y, u.x);
    const float tangent = std::sqrt(half * half - radius * radius);
    const cv::Point2f foot = base.a - centre - u * (radius * radius / half);
    const cv::Point2f touch1 = foot + n * (radius * tangent / half);
    const cv::Point2f touch2 = foot - n * (radius * tangent / half);
    normal1 = {-touch1.y, touch1.x};
    normal2 = {-touch2.y, touch2.x};
    if ((normal1.dot(u) > 0) != (normal2.dot(u) > 0)) {
      normal2 = -normal2;
    }
  }

  bool contains(cv::Point2f p) const {
    return everywhere || (normal1.dot(p - centre) > 0) == (normal2.dot(p - centre) > 0);
  }
};

const LineSegments& Grouping::run(const LineSegments& segments, cv::Size size) {
  if (!validity_ || validity_->size() != size) {
    validity_ = std::make_unique<Validity>(size, parameters_.segment_density);
  }
  segments_.clear();
  for (const LineSegment& line : segments) {
    Segment segment;
    segment.a = {static_cast<float>(line.x1), static_cast<float>(line.y1)};
    segment.b = {static_cast<float>(line.x2), static_cast<float>(line.y2)};
    segment.length = distance(segment.a, segment.b);
    segments_.push_back(segment);
  }
  sortByLength(size);
  sortByOrientation();
  merged_.assign(segments_.size(), 0);
  lines_.clear();
  const float shortest = kShortest * static_cast<float>(size.width + size.height) / 2;
  for (const std::uint32_t i : order_) {
    const Segment& segment = segments_[i];
    if (segment.length < shortest) {
      if (segment.length >= parameters_.min_line_length) {
        emit(segment);
      }
    } else if (merged_[i] == 0) {
      growGroup(i);
    }
  }
  return lines_;
}

void Grouping::sortByLength(cv::Size size) {
  const double bin = std::hypot(size.width, size.height) / parameters_.length_bins;
  order_.resize(segments_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double bin_of_a = std::floor(segments_[a].length / bin);
    const double bin_of_b = std::floor(segments_[b].length / bin);
    return bin_of_a != bin_of_b ? bin_of_a > bin_of_b : a < b;
  });
}

void Grouping::sortByOrientation() {
  const auto count = static_cast<std::size_t>(parameters_.orientation_bins);
  bins_.resize(count);
  for (std::vector<std::uint32_t>& bin : bins_) bin.clear();
  orientation_.clear();
  for (const Segment& segment : segments_) {
    // Of the normal, turned to the right.
    float x = segment.b.y - segment.a.y;
    float y = segment.a.x - segment.b.x;
    if (x < 0) {
      x = -x;
      y = -y;
    }
    const double turns = (CV_PI / 2 + std::atan2(y, x)) / CV_PI;
    const auto bin = static_cast<std::size_t>(turns * static_cast<double>(count)) % count;
    bins_[bin].push_back(static_cast<std::uint32_t>(orientation_.size()));
    orientation_.push_back(static_cast<std::uint32_t>(bin));
  }
}

void Grouping::take(std::size_t segment) {
  std::vector<std::uint32_t>& bin = bins_[orientation_[segment]];
  bin.erase(std::find(bin.begin(), bin.end(), segment));
  merged_[segment] = 1;
  group_.push_back(segments_[segment]);
}

void Grouping::collectCandidates(std::size_t segment) {
  const std::size_t bin = orientation_[segment];
  candidates_.clear();
  for (const std::size_t b :
       {bin, (bin + bins_.size() - 1) % bins_.size(), (bin + 1) % bins_.size()}) {
    candidates_.insert(candidates_.end(), bins_[b].begin(), bins_[b].end());
  }
}

void Grouping::growGroup(std::size_t first) {
  group_.clear();
  take(first);
  startModel(segments_[first]);
  collectCandidates(first);
  while (!candidates_.empty()) {
    const std::size_t best = bestCandidate();
    candidates_.swap(remaining_);
    if (best == segments_.size()) {
      break;
    }
    candidates_.erase(std::find(candidates_.begin(), candidates_.end(), best));
    take(best);
    extendModel(segments_[best]);
  }
  if (group_.size() > 1) {
    emit(model_.base);
  } else if (group_.front().length >= parameters_.min_line_length) {
    emit(group_.front());
  }
}

std::size_t Grouping::bestCandidate() {
  const Cone cone(model_.base, static_cast<float>(parameters_.endpoint_error));
  std::size_t best = segments_.size();
  double least = 0;  // of the logarithm: one false alarm
  remaining_.clear();
  for (const std::uint32_t i : candidates_) {
    const Segment& candidate = segments_[i];
    if (!cone.contains(middle(candidate))) {
      continue;
    }
    remaining_.push_back(i);
    if (!isNear(candidate)) {
      continue;
    }
    const double log_nfa = validity_->logNfa(group_, candidate);
    if (log_nfa < least && !overlaps(candidate)) {
      least = log_nfa;
      best = i;
    }
  }
  return best;
}

bool Grouping::isNear(const Segment& candidate) const {
  const Segment& base = model_.base;
  const std::array<float, 4> distances = {
      distance(base.a, candidate.a), distance(base.a, candidate.b), distance(base.b, candidate.a),
      distance(base.b, candidate.b)};
  const auto [least, greatest] = std::minmax_element(distances.begin(), distances.end());
  if (*greatest < base.length) {
    return true;
  }
  const double mean = 0.5 * (candidate.length + base.length / static_cast<float>(group_.size()));
  return *least / mean <= parameters_.max_gap;
}

bool Grouping::overlaps(const Segment& candidate) const {
  double sum = 0;
  for (const Segment& member : group_) {
    sum += overlap(member, candidate);
    if (sum > parameters_.max_overlap) {
      return true;
    }
  }
  return false;
}

void Grouping::startModel(const Segment& segment) {
  model_ = Model();
  model_.horizontal = std::abs(segment.b.x - segment.a.x) >= std::abs(segment.b.y - segment.a.y);
  model_.base = segment;
  for (const cv::Point2f& p : {segment.a, segment.b}) {
    const float u = model_.horizontal ? p.x : p.y;
    const float v = model_.horizontal ? p.y : p.x;
    model_.n += 1;
    model_.su += u;
    model_.sv += v;
    model_.suu += u * u;
    model_.suv += u * v;
  }
}

void Grouping::extendModel(const Segment& segment) {
  const Segment base = model_.base;
  const bool horizontal = model_.horizontal;
  for (const cv::Point2f& p : {segment.a, segment.b}) {
    const float u = horizontal ? p.x : p.y;
    const float v = horizontal ? p.y : p.x;
    model_.n += 1;
    model_.su += u;
    model_.sv += v;
    model_.suu += u * u;
    model_.suv += u * v;
  }
  // slope u + spread v + c = 0
  double slope = model_.n * model_.suv - model_.su * model_.sv;
  double spread = model_.su * model_.su - model_.n * model_.suu;
  double c = model_.sv * model_.suu - model_.su * model_.suv;
  const double norm = std::hypot(slope, spread);
  slope /= norm;
  spread /= norm;
  c /= norm;
  const auto a = static_cast<float>(horizontal ? slope : spread);
  const auto b = static_cast<float>(horizontal ? spread : slope);
  const auto project = [&](cv::Point2f p) {
    const float away = a * p.x + b * p.y + static_cast<float>(c);
    return cv::Point2f(p.x - away * a, p.y - away * b);
  };
  Segment longest = base;
  float greatest = base.length;
  for (const cv::Point2f& from : {base.a, base.b}) {
    for (const cv::Point2f& to : {segment.a, segment.b}) {
      if (distance(from, to) > greatest) {
        greatest = distance(from, to);
        longest.a = from;
        longest.b = to;
      }
    }
  }
  model_.base.a = project(longest.a);
  model_.base.b = project(longest.b);
  model_.base.length = distance(model_.base.a, model_.base.b);
}

void Grouping::emit(const Segment& segment) {
  LineSegment line;
  line.x1 = segment.a.x;
  line.y1 = segment.a.y;
  line.x2 = segment.b.x;
  line.y2 = segment.b.y;
  lines_.push_back(line);
}

}  // namespace evolin::fsg
