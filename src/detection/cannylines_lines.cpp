// Splitting, extending and merging, validation.
#include "cannylines_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace evolin::cannylines {
namespace {

constexpr double kChance = 0.125;      // of a direction within 22.5 degrees
constexpr double kSplitDeviation = 2;  // pixels
constexpr double kTrimmedOffset = 1;   // pixels
constexpr double kGapShare = 0.25;     // gaps to edge pixels that end an extension
constexpr int kMostGaps = 2;           // until both are counted anew
constexpr int kMergeDistance = 4;      // pixels between ends
constexpr double kWorstPixel = 3;      // of fit_error, in a merged line

bool isSteep(EdgePixel a, EdgePixel b) { return std::abs(a.y - b.y) >= std::abs(a.x - b.x); }

double directionOf(const Line& line) {
  const EdgePixel a = line.pixels.front();
  const EdgePixel b = line.pixels.back();
  return std::atan2(b.y - a.y, b.x - a.x);
}

/// The angle between two undirected lines.
double turnBetween(const Line& a, const Line& b) {
  return std::abs(std::remainder(directionOf(a) - directionOf(b), CV_PI));
}

}  // namespace

const LineSegments& LineFinder::find(const EdgeFinder& edges) {
  edges_ = &edges;
  width_ = edges.maps().width;
  height_ = edges.maps().height;
  meaningful_length_ = edges.meaningfulLength();
  segments_.clear();
  count_ = 0;
  if (edges.chains().size() == 0) {
    return segments_;
  }
  most_turn_ = 2 * std::atan(2 / static_cast<double>(meaningful_length_));
  startLabels();
  for (std::size_t i = 0; i < edges.chains().size(); ++i) {
    split(edges.chains().data(i), edges.chains().length(i));
  }
  longest_first_.clear();
  for (std::size_t i = 0; i < count_; ++i) {
    if (lines_[i].pixels.size() > 2 * meaningful_length_) longest_first_.push_back(i);
  }
  std::sort(longest_first_.begin(), longest_first_.end(), [this](std::size_t a, std::size_t b) {
    const std::size_t of_a = lines_[a].pixels.size();
    const std::size_t of_b = lines_[b].pixels.size();
    return of_a != of_b ? of_a > of_b : a < b;
  });
  for (const std::size_t i : longest_first_) {
    if (!lines_[i].merged) grow(i);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Line& line = lines_[i];
    if (!line.merged && line.pixels.size() >= meaningful_length_ &&
        (!parameters_.validate || isMeaningful(line))) {
      segments_.push_back(line.segment);
    }
  }
  return segments_;
}

// ---- labels

void LineFinder::startLabels() {
  labels_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNone);
  for (const EdgePixel& p : edges_->edgePixels()) {
    labels_[edges_->maps().at(p.x, p.y)] = kFree;
  }
}

std::int32_t LineFinder::labelAt(int x, int y) const {
  return x < 0 || y < 0 || x >= width_ || y >= height_ ? kNone : labels_[edges_->maps().at(x, y)];
}

void LineFinder::label(const Line& line, std::int32_t value) {
  for (const EdgePixel& p : line.pixels) labels_[edges_->maps().at(p.x, p.y)] = value;
}

// ---- pieces of chains

void LineFinder::split(const EdgePixel* pixels, std::size_t size) {
  const std::size_t shortest = std::max<std::size_t>(3, meaningful_length_ / 2) / 2;
  const EdgePixel a = pixels[0];
  const EdgePixel b = pixels[size - 1];
  std::int64_t greatest = 0;
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::int64_t cross = std::abs(std::int64_t{pixels[i].x - a.x} * (a.y - b.y) +
                                        std::int64_t{pixels[i].y - a.y} * (b.x - a.x));
    if (cross > greatest) {
      greatest = cross;
      farthest = i;
    }
  }
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (static_cast<double>(greatest) >= kSplitDeviation * length && farthest + 1 >= shortest &&
      size - farthest >= shortest && farthest > 0 && farthest + 1 < size) {
    split(pixels, farthest + 1);
    split(pixels + farthest, size - farthest);
    return;
  }
  addLine(pixels, size);
}

void LineFinder::addLine(const EdgePixel* pixels, std::size_t size) {
  if (count_ == lines_.size()) {
    lines_.emplace_back();
  }
  Line& line = lines_[count_];
  line.merged = false;
  line.pixels.assign(pixels, pixels + size);
  line.equation = fitter_.fit(line.pixels, isSteep(pixels[0], pixels[size - 1]));
  // Both ends begin with the second pixel that is near the line.
  const auto secondNear = [&](auto first, auto last) {
    int near = 0;
    for (; first != last; ++first) {
      if (line.equation.offset(*first) < kTrimmedOffset && ++near == 2) {
        break;
      }
    }
    return first;
  };
  const auto end = secondNear(line.pixels.rbegin(), line.pixels.rend()).base();
  line.pixels.erase(end, line.pixels.end());
  const auto begin = secondNear(line.pixels.begin(), line.pixels.end());
  line.pixels.erase(line.pixels.begin(), begin);
  if (line.pixels.empty()) {
    return;
  }
  ++count_;
  label(line, -static_cast<std::int32_t>(count_));
  placeEnds(&line);
}

void LineFinder::placeEnds(Line* line) const {
  const LineEquation& equation = line->equation;
  const double u1 = equation.u(line->pixels.front());
  const double u2 = equation.u(line->pixels.back());
  line->segment = equation.steep ? LineSegment{equation.at(u1), u1, equation.at(u2), u2}
                                 : LineSegment{u1, equation.at(u1), u2, equation.at(u2)};
}

// ---- growth

void LineFinder::grow(std::size_t index) {
  extend(index);
  Line& line = lines_[index];
  std::reverse(line.pixels.begin(), line.pixels.end());
  extend(index);
  line.equation = fitter_.fitByStrength(line.pixels, line.equation.steep, *edges_);
  placeEnds(&line);
}

/// Of the lines that `labels` name, that of the most similar direction.
std::size_t LineFinder::nearestInDirection(std::size_t index,
                                           const std::int32_t (&labels)[3]) const {
  const std::int32_t own = -static_cast<std::int32_t>(index) - 1;
  std::size_t best = count_;
  double least = 0;
  for (const std::int32_t label : labels) {
    if (label >= 0 || label == own) {
      continue;
    }
    const auto other = static_cast<std::size_t>(-label - 1);
    const double turn = turnBetween(lines_[index], lines_[other]);
    if (best == count_ || turn < least) {
      best = other;
      least = turn;
    }
  }
  return best;
}

/// Goes on from the line's last pixel.
void LineFinder::extend(std::size_t index) {
  const std::int32_t own = -static_cast<std::int32_t>(index) - 1;
  Line& line = lines_[index];
  Growth growth;
  growth.fitted = line.pixels.size();
  int u = line.equation.u(line.pixels.back());
  while (true) {
    const bool steep = line.equation.steep;
    const int step =
        line.equation.u(line.pixels.back()) > line.equation.u(line.pixels.front()) ? 1 : -1;
    u += step;
    const int end = steep ? height_ : width_;
    const int beside = (steep ? width_ : height_) + 1;
    // Single precision may lead far away; beyond the border all places are alike.
    const int v =
        static_cast<int>(std::clamp<double>(std::floor(line.equation.at(u) + 0.5), -2, beside));
    if (u < 0 || u >= end) {
      break;
    }
    std::int32_t labels[3];
    for (int k = 0; k < 3; ++k) {
      const int across = v + (k == 0 ? 0 : k == 1 ? -1 : 1);
      labels[k] = steep ? labelAt(across, u) : labelAt(u, across);
    }
    const std::size_t other = nearestInDirection(index, labels);
    if (other != count_) {
      if (!tryToMerge(index, other)) {
        break;
      }
      growth = {};
      growth.fitted = line.pixels.size();
      u = line.equation.u(line.pixels.back());
      continue;
    }
    bool stops = false;
    if (std::count(labels, labels + 3, kFree) == 1 && std::count(labels, labels + 3, kNone) == 2) {
      if (labels[2] == kFree) {
        // The published code has pixels on that side neither continue nor end a line.
        ++growth.gaps;
        continue;
      }
      const int across = labels[0] == kFree ? v : v - 1;
      const EdgePixel p = steep ? EdgePixel{across, u} : EdgePixel{u, across};
      line.pixels.push_back(p);
      labels_[edges_->maps().at(p.x, p.y)] = own;
      ++growth.edges;
    } else {
      ++growth.gaps;
      stops = growth.edges == 0 || growth.gaps >= kGapShare * growth.edges;
    }
    if (stops) {
      break;
    }
    if (growth.gaps == kMostGaps) {
      growth.gaps = growth.edges = 0;
    }
    if (line.pixels.size() - growth.fitted >= meaningful_length_) {
      line.equation = fitter_.fit(line.pixels, isSteep(line.pixels.front(), line.pixels.back()));
      growth.fitted = line.pixels.size();
      u = line.equation.u(line.pixels.back());
    }
  }
  line.pixels.resize(growth.fitted);
}

/// Takes over the pixels of another line that goes on where this one ends.
bool LineFinder::tryToMerge(std::size_t index, std::size_t other) {
  Line& line = lines_[index];
  Line& next = lines_[other];
  if (next.merged || turnBetween(line, next) > most_turn_) {
    return false;
  }
  const LineEquation& equation = line.equation;
  const int end = equation.u(line.pixels.back());
  const int step = end > equation.u(line.pixels.front()) ? 1 : -1;
  const int first = (equation.u(next.pixels.front()) - end) * step;
  const int last = (equation.u(next.pixels.back()) - end) * step;
  const bool turned = std::abs(last) < std::abs(first);
  const int near = turned ? last : first;
  const int far = turned ? first : last;
  if (std::abs(near) >= kMergeDistance || far <= 0) {
    return false;
  }
  joined_.assign(line.pixels.begin(), line.pixels.end());
  if (turned) {
    joined_.insert(joined_.end(), next.pixels.rbegin(), next.pixels.rend());
  } else {
    joined_.insert(joined_.end(), next.pixels.begin(), next.pixels.end());
  }
  const LineEquation fitted = fitter_.fit(joined_, isSteep(joined_.front(), joined_.back()));
  double squares = 0;
  double worst = 0;
  for (const EdgePixel& p : joined_) {
    const double offset = std::abs(fitted.offset(p));
    squares += offset * offset;
    worst = std::max(worst, offset);
  }
  const double error = std::sqrt(squares / static_cast<double>(joined_.size()));
  if (error >= parameters_.fit_error || worst >= kWorstPixel * parameters_.fit_error) {
    return false;
  }
  next.merged = true;
  line.equation = fitted;
  line.pixels.swap(joined_);
  label(line, -static_cast<std::int32_t>(index) - 1);
  return true;
}

// ---- validation

bool LineFinder::isMeaningful(const Line& line) {
  const LineSegment& s = line.segment;
  const double length = s.length();
  if (!(length > 0)) {
    return false;
  }
  const double along_x = (s.x2 - s.x1) / length;
  const double along_y = (s.y2 - s.y1) / length;
  const double least_dot = std::cos(CV_PI / 8);
  int with = 0;
  int against = 0;
  int weakest = edges_->strength(line.pixels.front());
  for (const EdgePixel& p : line.pixels) {
    const std::int16_t* derivatives =
        edges_->maps().derivatives.data() + 2 * edges_->maps().at(p.x, p.y);
    const double dx = derivatives[0];
    const double dy = derivatives[1];
    const double dot = (-dy * along_x + dx * along_y) / std::hypot(dx, dy);
    with += dot >= least_dot ? 1 : 0;
    against += dot <= -least_dot ? 1 : 0;
    weakest = std::min(weakest, edges_->strength(p));
  }
  const auto n = static_cast<double>(line.pixels.size());
  const double log_weak = n * std::log(edges_->shareFrom(weakest));
  const double pixels = static_cast<double>(width_) * height_;
  const double log_rest = log_weak + 2 * std::log(pixels) + edges_->logPairs();
  // The binomial tail, from all aligned downwards.
  double log_term = n * std::log(kChance);
  double tail = 0;
  for (double k = n; k >= std::max(with, against); --k) {
    tail += std::exp(log_term + log_rest);
    log_term += std::log(k / (n - k + 1)) + std::log((1 - kChance) / kChance);
  }
  return tail <= 1;
}

}  // namespace evolin::cannylines
