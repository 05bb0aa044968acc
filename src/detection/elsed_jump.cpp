// ELSED's jump over a junction: a segment goes on beyond a gap where the gradients there agree with
// it.
#include <algorithm>
#include <array>
#include <cmath>

#include "elsed_drawing.h"

namespace evolin::elsed {
namespace {

constexpr std::array<int, 3> kJumps = {5, 7, 9};  // pixels
constexpr double kPi = 3.14159265358979323846;

/// Into [0, pi): the direction of a line, whichever way it points.
double undirected(double angle) {
  angle = std::fmod(angle, kPi);
  return angle < 0 ? angle + kPi : angle;
}

/// Between two undirected angles, radians, 0 to pi / 2.
double difference(double a, double b) {
  const double apart = std::abs(a - b);
  return std::min(apart, kPi - apart);
}

}  // namespace

void Drawing::bresenham(EdgePixel from, EdgePixel to) {
  const int dx = std::abs(to.x - from.x);
  const int dy = std::abs(to.y - from.y);
  const int step_x = from.x < to.x ? 1 : -1;
  const int step_y = from.y < to.y ? 1 : -1;
  int error = dx - dy;
  EdgePixel p = from;
  while (true) {
    junction_.push_back(p);
    if (p == to) {
      return;
    }
    const int twice = 2 * error;
    if (twice >= -dy) {
      error -= dy;
      p.x += step_x;
    }
    if (twice <= dx) {
      error += dx;
      p.y += step_y;
    }
  }
}

bool Drawing::jump(Side side) {
  if (!parameters_.junctions) {
    return false;
  }
  const IncrementalLine::Equation line = line_.equation();
  const double sign = side == Side::kEnd ? 1 : -1;
  const EdgePixel from = tip(side).pixel;
  beyond_.clear();
  for (const int steps : kJumps) {
    if (line_.size() <= steps) {
      break;
    }
    const auto [on_x, on_y] = line.project(from.x, from.y);
    const auto x = static_cast<float>(on_x - sign * steps * line.b);
    const auto y = static_cast<float>(on_y + sign * steps * line.a);
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(maps_->width) &&
          y < static_cast<float>(maps_->height))) {
      continue;
    }
    const EdgePixel corner{static_cast<int>(x), static_cast<int>(y)};
    EdgePixel target = corner;
    for (const EdgePixel offset : {EdgePixel{1, 0}, EdgePixel{0, 1}, EdgePixel{1, 1}}) {
      const EdgePixel p{corner.x + offset.x, corner.y + offset.y};
      if (p.x < maps_->width && p.y < maps_->height &&
          strength(p.x, p.y) > strength(target.x, target.y)) {
        target = p;
      }
    }
    if (strength(target.x, target.y) == 0 || target == from) {
      continue;
    }
    junction_.clear();
    bresenham(from, target);
    if (walkBeyond(steps) && gradientsAgree(line)) {
      addJunction(side);
      return true;
    }
  }
  return false;
}

bool Drawing::walkBeyond(int steps) {
  const double squared_distance = parameters_.pixel_distance * parameters_.pixel_distance;
  Walker walker;
  walker.at = junction_.back();
  walker.before = junction_[junction_.size() - 2];
  for (int i = 0; i < steps; ++i) {
    walker.vertical = !line_.horizontal();
    if (!step(&walker) || !line_.isNear(walker.at, squared_distance)) {
      return false;
    }
    junction_.push_back(walker.at);
    beyond_.push_back(walker.at);
  }
  return true;
}

bool Drawing::gradientsAgree(const IncrementalLine::Equation& line) const {
  // The gradients' second moments: one direction prevails, and it stands across the line.
  float xx = 0;
  float xy = 0;
  float yy = 0;
  for (const EdgePixel& p : beyond_) {
    for (int k = -1; k <= 1; ++k) {
      const int x = std::clamp(p.x + (line_.horizontal() ? 0 : k), 0, maps_->width - 1);
      const int y = std::clamp(p.y + (line_.horizontal() ? k : 0), 0, maps_->height - 1);
      const std::int16_t* gradient = maps_->derivatives.data() + 2 * maps_->at(x, y);
      const auto dx = static_cast<float>(gradient[0]);
      const auto dy = static_cast<float>(gradient[1]);
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  }
  const double a = xx;
  const double b = xy;
  const double d = yy;
  const double sum = a * a + 2 * b * b + d * d;
  const double difference_of_squares = a * a - d * d;
  const double spread =
      std::sqrt(difference_of_squares * difference_of_squares + 4 * b * b * (a + d) * (a + d));
  const double smaller = std::max(0.0, sum - spread) + 1e-5;
  if (!(std::sqrt((sum + spread) / smaller) > parameters_.junction_eigenvalues)) {
    return false;
  }
  const double across = undirected(-0.5 * std::atan2(2 * a * b + 2 * b * d, difference_of_squares));
  const double expected = undirected(std::atan2(line.a, line.b) + kPi / 2);
  return difference(across, expected) < parameters_.junction_angle * kPi / 180;
}

void Drawing::addJunction(Side side) {
  const double squared_distance = parameters_.pixel_distance * parameters_.pixel_distance;
  tip(side).extended = true;
  for (std::size_t i = 0; i < junction_.size(); ++i) {
    if (line_.isNear(junction_[i], squared_distance)) {
      setLabel(junction_[i], i < junction_.size() / 2 ? Label::kJunction : Label::kInlier);
      addToSegment(junction_[i], side);
    } else {
      setLabel(junction_[i], Label::kOutlier);
    }
  }
}

}  // namespace evolin::elsed
