// Region growing, rectangle fitting, and the standard refinement by density.
#include "lsd_region.h"

#include <algorithm>
#include <cmath>

namespace evolin::lsd {
namespace {

constexpr double kPi = CV_PI;
constexpr double kDegree = CV_PI / 180;

double square(double value) { return value * value; }

}  // namespace

double Rectangle::length() const { return std::hypot(x2 - x1, y2 - y1); }

void RegionGrower::start(const Field& field) {
  field_ = &field;
  // Nothing grows into pixels without a level line.
  used_.assign(field.size(), 1);
  for (const std::int32_t seed : field.seeds) used_[static_cast<std::size_t>(seed)] = 0;
  region_.clear();
}

void RegionGrower::grow(std::int32_t seed, double tolerance) {
  const std::int32_t width = field_->width;
  region_.clear();
  region_.push_back({seed % width, seed / width});
  used_[static_cast<std::size_t>(seed)] = 1;
  angle_ = field_->angles[static_cast<std::size_t>(seed)];
  auto cosines = static_cast<float>(std::cos(angle_));
  auto sines = static_cast<float>(std::sin(angle_));
  const auto take = [&](std::size_t i, std::int32_t x, std::int32_t y) {
    const double angle = field_->angles[i];
    if (angleBetween(angle_, angle) > tolerance) {
      return;
    }
    used_[i] = 1;
    region_.push_back({x, y});
    cosines += std::cos(static_cast<float>(angle));
    sines += std::sin(static_cast<float>(angle));
    angle_ = cv::fastAtan2(sines, cosines) * kDegree;
  };
  // Neighbours in rows; the last row and column have no level lines, so only the first ones need
  // care.
  for (std::size_t next = 0; next < region_.size(); ++next) {
    const RegionPixel p = region_[next];
    for (std::int32_t y = std::max(p.y - 1, 0); y <= p.y + 1; ++y) {
      const std::size_t i = at({p.x, y});
      if (p.x > 0 && used_[i - 1] == 0) take(i - 1, p.x - 1, y);
      if (used_[i] == 0) take(i, p.x, y);
      if (used_[i + 1] == 0) take(i + 1, p.x + 1, y);
    }
  }
}

double RegionGrower::principalAngle(double x, double y, double tolerance) const {
  double xx = 0;
  double yy = 0;
  double xy = 0;
  for (const RegionPixel& p : region_) {
    const double weight = field_->magnitudes[at(p)];
    xx += square(p.y - y) * weight;
    yy += square(p.x - x) * weight;
    xy -= (p.x - x) * (p.y - y) * weight;
  }
  const double smallest = 0.5 * (xx + yy - std::sqrt(square(xx - yy) + 4 * square(xy)));
  double angle = std::abs(xx) > std::abs(yy)
                     ? cv::fastAtan2(static_cast<float>(smallest - xx), static_cast<float>(xy))
                     : cv::fastAtan2(static_cast<float>(xy), static_cast<float>(smallest - yy));
  angle *= kDegree;
  // The axis has two directions; that of the level lines counts.
  double apart = angle - angle_;
  while (apart <= -kPi) apart += 2 * kPi;
  while (apart > kPi) apart -= 2 * kPi;
  return std::abs(apart) > tolerance ? angle + kPi : angle;
}

Rectangle RegionGrower::fit(double tolerance, double chance) const {
  double x = 0;
  double y = 0;
  double sum = 0;
  for (const RegionPixel& p : region_) {
    const double weight = field_->magnitudes[at(p)];
    x += p.x * weight;
    y += p.y * weight;
    sum += weight;
  }
  x /= sum;
  y /= sum;
  Rectangle rectangle;
  rectangle.angle = principalAngle(x, y, tolerance);
  rectangle.dx = std::cos(rectangle.angle);
  rectangle.dy = std::sin(rectangle.angle);
  double along_low = 0;
  double along_high = 0;
  double across_low = 0;
  double across_high = 0;
  for (const RegionPixel& p : region_) {
    const double along = (p.x - x) * rectangle.dx + (p.y - y) * rectangle.dy;
    const double across = -(p.x - x) * rectangle.dy + (p.y - y) * rectangle.dx;
    along_low = std::min(along_low, along);
    along_high = std::max(along_high, along);
    across_low = std::min(across_low, across);
    across_high = std::max(across_high, across);
  }
  rectangle.x1 = x + along_low * rectangle.dx;
  rectangle.y1 = y + along_low * rectangle.dy;
  rectangle.x2 = x + along_high * rectangle.dx;
  rectangle.y2 = y + along_high * rectangle.dy;
  rectangle.width = std::max(1.0, across_high - across_low);
  rectangle.tolerance = tolerance;
  rectangle.chance = chance;
  return rectangle;
}

void RegionGrower::release() {
  for (const RegionPixel& p : region_) used_[at(p)] = 0;
}

bool RegionGrower::refine(double density, Rectangle* rectangle) {
  const auto filled = [&] {
    return static_cast<double>(region_.size()) / (rectangle->length() * rectangle->width);
  };
  if (filled() >= density) {
    return true;
  }
  // The spread of the angles around the seed, instead of the general tolerance.
  const RegionPixel seed = region_.front();
  const double seed_angle = field_->angles[at(seed)];
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const RegionPixel& p : region_) {
    if (std::hypot(p.x - seed.x, p.y - seed.y) >= rectangle->width) {
      continue;
    }
    double apart = field_->angles[at(p)] - seed_angle;
    while (apart <= -kPi) apart += 2 * kPi;
    while (apart > kPi) apart -= 2 * kPi;
    sum += apart;
    squares += apart * apart;
    ++count;
  }
  const double mean = sum / count;
  const double tolerance =
      2 * std::sqrt(std::max(0.0, (squares - 2 * mean * sum) / count + mean * mean));
  release();
  grow(static_cast<std::int32_t>(at(seed)), tolerance);
  if (region_.size() < 2) {
    return false;
  }
  *rectangle = fit(rectangle->tolerance, rectangle->chance);
  return filled() >= density || shrink(density, rectangle);
}

bool RegionGrower::shrink(double density, Rectangle* rectangle) {
  const RegionPixel seed = region_.front();
  double squared_radius = std::max(square(rectangle->x1 - seed.x) + square(rectangle->y1 - seed.y),
                                   square(rectangle->x2 - seed.x) + square(rectangle->y2 - seed.y));
  while (static_cast<double>(region_.size()) / (rectangle->length() * rectangle->width) < density) {
    squared_radius *= 0.75 * 0.75;
    for (std::size_t i = 0; i < region_.size();) {
      const RegionPixel p = region_[i];
      if (square(p.x - seed.x) + square(p.y - seed.y) > squared_radius) {
        used_[at(p)] = 0;
        region_[i] = region_.back();
        region_.pop_back();
      } else {
        ++i;
      }
    }
    if (region_.size() < 2) {
      return false;
    }
    *rectangle = fit(rectangle->tolerance, rectangle->chance);
  }
  return true;
}

}  // namespace evolin::lsd
