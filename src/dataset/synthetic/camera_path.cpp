// Place and angles as waves of different periods.
#include "evolin_ros/dataset/synthetic/camera_path.h"

#include <cmath>

#include "counter_random.h"

namespace evolin::synthetic {

namespace {

constexpr double kDegree = 0.017453292519943295;

/// middle + reach * sin(rate * time + phase)
struct Wave {
  double middle;
  double reach;
  double rate;  ///< radians a second
  double phase;

  double at(double time) const { return middle + reach * std::sin(rate * time + phase); }
};

}  // namespace

Pose cameraPose(std::uint64_t seed, double time) {
  RandomStream random(mixBits(seed, 0x70617468U));
  const auto shift = [&random] { return random.uniform(-0.35, 0.35); };
  const Wave x{1.15, 0.42, 0.9, -1.1 + shift()};
  const Wave y{0.95, 0.28, 0.7, 0.4 + shift()};
  const Wave z{1.5, 0.08, 1.3, shift()};
  const Wave heading{46 * kDegree, 17 * kDegree, 1.05, 1.9 + shift()};  // from east to north
  const Wave pitch{-9 * kDegree, 3 * kDegree, 1.2, shift()};
  // Never level: exactly horizontal or vertical lines are a special case for some metrics.
  const Wave roll{1.8 * kDegree, 1.2 * kDegree, 1.6, shift()};

  const double theta = heading.at(time);
  const double phi = pitch.at(time);
  const Eigen::Vector3d forward(std::cos(theta) * std::cos(phi), std::sin(theta) * std::cos(phi),
                                std::sin(phi));
  const Eigen::Vector3d right(std::sin(theta), -std::cos(theta), 0);
  Eigen::Matrix3d axes;
  axes.col(0) = right;
  axes.col(1) = forward.cross(right);
  axes.col(2) = forward;
  Pose pose;
  pose.rotation = Eigen::Quaterniond(axes) *
                  Eigen::Quaterniond(Eigen::AngleAxisd(roll.at(time), Eigen::Vector3d::UnitZ()));
  pose.rotation.normalize();
  pose.translation = {x.at(time), y.at(time), z.at(time)};
  return pose;
}

}  // namespace evolin::synthetic
