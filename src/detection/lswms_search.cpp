// Mean shift, growth, and the walk over pixels, in the single precision of the published code: its
// lines depend on the last bits.
#include "lswms_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

namespace evolin::lswms {
namespace {

constexpr float kPi = 3.14159265358979323846F;
constexpr float kHalfPi = kPi / 2;
constexpr float kUnknown = 5;  // no angle has that value
constexpr int kFar = 1000;     // pixels: a walk's target

cv::Point2f towardsRight(cv::Point2f v) { return v.x < 0 ? cv::Point2f(-v.x, -v.y) : v; }

/// |value| / 8, halves to the even number.
int roundedEighth(int value) {
  const int size = std::abs(value);
  return (size + 3 + (size / 8 & 1)) / 8;
}

/// Of a gradient (dx, dy), radians; 0 where there is none.
float angleOf(const std::int16_t* gradient) {
  if (gradient[1] == 0) {
    return 0;  // as dx >= 0
  }
  return std::atan2(static_cast<float>(gradient[1]), static_cast<float>(gradient[0]));
}

int squaredDistance(cv::Point a, cv::Point b) {
  const cv::Point d = a - b;
  return d.dot(d);
}

}  // namespace

Search::Search(const LswmsParameters& parameters)
    : radius_(parameters.radius),
      tolerance_(static_cast<float>(parameters.angle_tolerance * CV_PI / 180)),
      max_error_(static_cast<float>(parameters.max_error)),
      gradient_(1, 1.0) {}

void Search::buildMaps(const cv::Mat& gray) {
  margin_ = 2 * radius_ + 1;
  margin_ += (gray.cols + 2 * margin_) % 4 / 2;
  cv::copyMakeBorder(gray, padded_, margin_, margin_, margin_, margin_,
                     cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  gradient_.compute(padded_, 0, &maps_);
  const std::size_t pixels = maps_.strength.size();
  strength_.resize(pixels);
  std::uint64_t sum = 0;
  std::int16_t* gradients = maps_.derivatives.data();
  for (std::size_t i = 0; i < pixels; ++i) {
    const int dx = gradients[2 * i];
    const int dy = gradients[2 * i + 1];
    const int strength = std::min(roundedEighth(dx) + roundedEighth(dy), 255);
    strength_[i] = static_cast<std::uint8_t>(strength);
    sum += static_cast<std::uint64_t>(strength);
    gradients[2 * i] = static_cast<std::int16_t>(std::abs(dx));
    gradients[2 * i + 1] = static_cast<std::int16_t>(dx < 0 ? -dy : dy);
  }
  // No line ends in the frame: nothing grows through it.
  const int frame = margin_ + radius_;
  for (int y = 0; y < maps_.height; ++y) {
    const bool whole = y < frame || y >= maps_.height - frame;
    const int width = whole ? maps_.width : std::min(frame, maps_.width);
    for (const int x : {0, maps_.width - width}) {
      const std::size_t begin = maps_.at(x, y);
      std::fill_n(gradients + 2 * begin, 2 * width, std::int16_t{0});
      std::fill_n(strength_.data() + begin, width, std::uint8_t{0});
    }
  }
  threshold_ = static_cast<int>(sum / pixels);
  raw_angles_.assign(pixels, kUnknown);
  angles_.assign(pixels, kUnknown);
  visited_.assign(pixels, 1);
  for (int y = margin_; y < maps_.height - margin_; ++y) {
    const auto row = visited_.begin() + static_cast<std::ptrdiff_t>(maps_.at(margin_, y));
    std::fill(row, row + gray.cols, std::uint8_t{0});
  }
}

float Search::cachedAngle(std::size_t i) {
  if (angles_[i] == kUnknown) {
    angles_[i] = angleOf(maps_.derivatives.data() + 2 * i);
  }
  return angles_[i];
}

const std::vector<Found>& Search::run(const cv::Mat& gray) {
  found_.clear();
  buildMaps(gray);
  if (threshold_ == 0) {
    return found_;
  }
  for (int y = margin_; y < maps_.height - margin_; ++y) {
    for (int x = margin_; x < maps_.width - margin_; ++x) {
      const std::size_t i = maps_.at(x, y);
      if (visited_[i] != 0 || strength_[i] <= threshold_) {
        continue;
      }
      Found found;
      if (generate({x, y}, &found) && found.published_error < max_error_) {
        const cv::Point origin(margin_, margin_);
        found.a -= origin;
        found.b -= origin;
        found_.push_back(found);
      } else {
        markVisited({x - radius_, y - radius_, margin_, margin_});
      }
    }
  }
  return found_;
}

bool Search::generate(cv::Point seed, Found* found) {
  const std::int16_t* gradient = maps_.derivatives.data() + 2 * maps_.at(seed.x, seed.y);
  Ridge ridge;
  if (!meanShift(seed, cv::Point2f(gradient[0], gradient[1]), true, &ridge)) {
    return false;
  }
  const cv::Point centre = ridge.at;
  const Growth one = grow(centre, ridge.gradient, false);
  const Growth other = grow(centre, ridge.gradient, true);
  // The longer way gives the direction for the opposite one.
  const bool first = squaredDistance(one.end, centre) >= squaredDistance(other.end, centre);
  const Growth& longer = first ? one : other;
  Growth opposite = longer;
  opposite.end = centre;
  if (longer.end != centre) {
    const cv::Point d = centre - longer.end;
    const auto length = static_cast<float>(std::sqrt(static_cast<double>(d.dot(d))));
    opposite = grow(
        centre, cv::Point2f(static_cast<float>(d.y) / length, -static_cast<float>(d.x) / length),
        false);
  }
  if (std::sqrt(static_cast<double>(squaredDistance(longer.end, opposite.end))) < margin_) {
    return false;
  }
  found->a = opposite.end;
  found->b = longer.end;
  found->published_error = opposite.published_error;
  found->error = opposite.error;
  markLine(longer.end, opposite.end);
  return true;
}

// ---- mean shift

bool Search::meanShift(cv::Point p, cv::Point2f gradient, bool avoid_visited, Ridge* ridge) {
  centres_.clear();
  while (true) {
    if (p.x < radius_ || p.y < radius_ || p.x >= maps_.width - radius_ ||
        p.y >= maps_.height - radius_ || (gradient.x == 0 && gradient.y == 0) ||
        (avoid_visited && visited_[maps_.at(p.x, p.y)] != 0) ||
        std::find(centres_.begin(), centres_.end(), p) != centres_.end()) {
      return false;
    }
    centres_.push_back(p);
    gradient = towardsRight(gradient);
    cv::Point offset;
    float mean = 0;
    if (!shiftOnce(p, std::atan2(gradient.y, gradient.x), &offset, &mean)) {
      return false;
    }
    gradient = {std::cos(mean), std::sin(mean)};
    if (offset == cv::Point(0, 0)) {
      *ridge = {p, towardsRight(gradient)};
      return true;
    }
    p += offset;
  }
}

bool Search::shiftOnce(cv::Point p, float angle, cv::Point* offset, float* mean) {
  const bool wraps = angle - tolerance_ < -kHalfPi || angle + tolerance_ > kHalfPi;
  const float low = wraps ? -tolerance_ : angle - tolerance_;
  const float high = wraps ? tolerance_ : angle + tolerance_;
  // Whole numbers that single precision would hold as well.
  int weight = 0;
  int columns = 0;
  int rows = 0;
  float angles = 0;
  const int side = 2 * radius_ + 1;
  for (int row = 0; row < side; ++row) {
    const std::size_t begin = maps_.at(p.x - radius_, p.y - radius_ + row);
    const std::uint8_t* strengths = strength_.data() + begin;
    const std::int16_t* gradients = maps_.derivatives.data() + 2 * begin;
    float* raw = raw_angles_.data() + begin;
    float* cached = angles_.data() + begin;
    int row_weight = 0;
    for (int column = 0; column < side; ++column) {
      if (raw[column] == kUnknown) {
        raw[column] = angleOf(gradients + 2 * column);
      }
      float value = raw[column];
      bool inside = false;
      if (wraps) {
        // Around the line's angle; the sum of both may then lie beyond a right angle, and stays so
        // for those who read it later.
        value -= angle;
        value += value < -kHalfPi ? kPi : value > kHalfPi ? -kPi : 0.0F;
        inside = value >= low && value <= high;
        value += angle;
      } else {
        inside = value >= low && value <= high;
      }
      cached[column] = value;
      const int strength = inside ? strengths[column] : 0;
      row_weight += strength;
      columns += (column + 1) * strength;
      angles += value * static_cast<float>(strength);
    }
    weight += row_weight;
    rows += (row + 1) * row_weight;
  }
  if (weight == 0) {
    return false;
  }
  const auto total = static_cast<float>(weight);
  const float x = static_cast<float>(columns) / total - 1;
  const float y = static_cast<float>(rows) / total - 1;
  *offset = {static_cast<int>(std::lrint(x)) - radius_, static_cast<int>(std::lrint(y)) - radius_};
  *mean = angles / total;
  return true;
}

// ---- growth

bool Search::agrees(float angle, float pixel_angle, float* difference) const {
  if (angle - tolerance_ < -kHalfPi) {
    if (pixel_angle < 0) {
      *difference = std::abs(angle - pixel_angle);
      return pixel_angle <= angle + tolerance_;
    }
    *difference = std::abs(angle - (pixel_angle - kPi));
    return pixel_angle >= angle - tolerance_ + kPi;
  }
  if (angle + tolerance_ > kHalfPi) {
    if (pixel_angle > 0) {
      *difference = std::abs(angle - pixel_angle);
      return pixel_angle >= angle - tolerance_;
    }
    *difference = std::abs(angle - (pixel_angle + kPi));
    return pixel_angle <= angle + tolerance_ - kPi;
  }
  *difference = std::abs(angle - pixel_angle);
  return *difference <= tolerance_;
}

Search::Walk Search::walk(cv::Point from, cv::Point to, float angle) {
  const int dx = std::abs(to.x - from.x);
  const int dy = std::abs(to.y - from.y);
  const int step_x = from.x < to.x ? 1 : -1;
  const int step_y = from.y < to.y ? 1 : -1;
  const int most_gaps = 2 * radius_;
  Walk result{from, kPi};
  float sum = 0;
  int accepted = 0;
  for (cv::Point p = from; isInside(p);) {
    const std::size_t i = maps_.at(p.x, p.y);
    if (strength_[i] == 0 && ++gaps_ >= most_gaps) {
      break;
    }
    float difference = 0;
    if (!agrees(angle, cachedAngle(i), &difference)) {
      break;
    }
    sum += difference;
    ++accepted;
    result.end = p;
    if (p == to) {
      break;
    }
    const int twice = 2 * carry_;
    if (twice > -dy) {
      carry_ -= dy;
      p.x += step_x;
    }
    if (twice < dx) {
      carry_ += dx;
      p.y += step_y;
    }
  }
  if (accepted > 0) {
    result.error = sum / static_cast<float>(accepted);
  }
  return result;
}

Search::Growth Search::grow(cv::Point from, cv::Point2f gradient, bool other_side) {
  if (other_side) {
    gradient = {-gradient.x, -gradient.y};
  }
  cv::Point begin = from;
  cv::Point target(from.x + static_cast<int>(-kFar * gradient.y),
                   from.y + static_cast<int>(kFar * gradient.x));
  cv::clipLine(padded_.size(), begin, target);
  gaps_ = 0;
  carry_ = std::abs(target.x - from.x) - std::abs(target.y - from.y);
  const Walk walked = walk(from, target, std::atan2(gradient.y, gradient.x));
  const Growth grown{walked.end, walked.error, walked.error};
  const cv::Point moved = walked.end - from;
  return std::abs(moved.x) > radius_ || std::abs(moved.y) > radius_ ? refine(from, gradient, grown)
                                                                    : grown;
}

Search::Growth Search::refine(cv::Point from, cv::Point2f gradient, Growth grown) {
  while (true) {
    // Where the end settles, the published code returns its success code for the error.
    Ridge ridge;
    if (!meanShift(grown.end, gradient, false, &ridge) || ridge.at == grown.end) {
      return {grown.end, 0, grown.error};
    }
    const cv::Point d = ridge.at - from;
    if (d == cv::Point(0, 0)) {
      return {ridge.at, 0, grown.error};
    }
    const auto length = static_cast<float>(std::sqrt(static_cast<double>(d.dot(d))));
    gradient = towardsRight({static_cast<float>(d.y) / length, -static_cast<float>(d.x) / length});
    const cv::Point target(from.x + static_cast<int>(-kFar * gradient.y),
                           from.y + static_cast<int>(kFar * gradient.x));
    if (target.y <= from.y) {
      // Otherwise the published code goes on with what the walk before has left.
      carry_ = std::abs(target.x - from.x) - std::abs(target.y - from.y);
    }
    const Walk walked = walk(from, target, std::atan2(gradient.y, gradient.x));
    if (grown.published_error <= walked.error) {
      return grown;
    }
    grown = {walked.end, walked.error, walked.error};
  }
}

// ---- visited pixels

void Search::markVisited(cv::Rect window) {
  window &= cv::Rect(0, 0, maps_.width, maps_.height);
  for (int y = window.y; y < window.y + window.height; ++y) {
    const auto row = visited_.begin() + static_cast<std::ptrdiff_t>(maps_.at(window.x, y));
    std::fill(row, row + window.width, std::uint8_t{1});
  }
}

void Search::markLine(cv::Point from, cv::Point to) {
  const int dx = std::abs(to.x - from.x);
  const int dy = std::abs(to.y - from.y);
  const int side = 2 * radius_ + 1;
  int carry = dx - dy;
  for (cv::Point p = from;;) {
    markVisited({p.x - radius_, p.y - radius_, side, side});
    if (p == to) {
      return;
    }
    const int twice = 2 * carry;
    if (twice > -dy) {
      carry -= dy;
      p.x += from.x < to.x ? 1 : -1;
    }
    if (twice < dx) {
      carry += dx;
      p.y += from.y < to.y ? 1 : -1;
    }
  }
}

}  // namespace evolin::lswms
