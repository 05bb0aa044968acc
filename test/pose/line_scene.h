// Drawn matches for tests of relative pose: lines in space seen by two cameras, with noise and
// wrong matches on demand, the same on every platform.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <vector>

#include "evolin_ros/pose/relative_pose.h"
#include "test/support/random_lines.h"

namespace evolin::test {

/// Fair stand-in for a normal variable of unit variance: the sum of twelve uniform ones.
inline double normal(RandomLines* random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) {
    sum += random->uniform(0, 1);
  }
  return sum;
}

inline Eigen::Vector2d projectPoint(const Camera& camera, const Eigen::Vector3d& point) {
  return {camera.fx * point.x() / point.z() + camera.cx,
          camera.fy * point.y() / point.z() + camera.cy};
}

inline Eigen::Vector3d backProjectPoint(const Camera& camera, const Eigen::Vector2d& pixel,
                                        double depth) {
  return {(pixel.x() - camera.cx) * depth / camera.fx, (pixel.y() - camera.cy) * depth / camera.fy,
          depth};
}

inline Pose motionOf(const Eigen::Vector3d& axis_angle, const Eigen::Vector3d& translation) {
  Pose pose;
  const double angle = axis_angle.norm();
  if (angle > 0) {
    pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis_angle / angle));
  }
  pose.translation = translation;
  return pose;
}

/// A segment in space, in the first camera's frame.
struct Segment3 {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

inline std::vector<Segment3> randomSegments(std::size_t count, RandomLines* random) {
  std::vector<Segment3> segments(count);
  for (Segment3& segment : segments) {
    for (Eigen::Vector3d* end : {&segment.a, &segment.b}) {
      const double z = random->uniform(1.5, 5);
      *end = {random->uniform(-0.5, 0.5) * z, random->uniform(-0.4, 0.4) * z, z};
    }
  }
  return segments;
}

/// What both cameras see of `segments`, exactly; the second sees another part of each line.
inline SpatialMatches observe(const std::vector<Segment3>& segments, const Pose& motion,
                              const Camera& camera) {
  SpatialMatches matches;
  for (const Segment3& segment : segments) {
    SpatialMatch match;
    match.match = matches.size();
    const Eigen::Vector3d shift = 0.1 * (segment.b - segment.a);
    match.first.point1 = segment.a;
    match.first.point2 = segment.b;
    match.second.point1 = motion.rotation * (segment.a + shift) + motion.translation;
    match.second.point2 = motion.rotation * (segment.b - shift) + motion.translation;
    for (LiftedLine* line : {&match.first, &match.second}) {
      line->pixel1 = projectPoint(camera, line->point1);
      line->pixel2 = projectPoint(camera, line->point2);
    }
    matches.push_back(match);
  }
  return matches;
}

/// Moves every endpoint by `pixels` times a normal variable in x and y, its point with it at the
/// same depth.
inline void addNoise(double pixels, const Camera& camera, RandomLines* random,
                     SpatialMatches* matches) {
  const auto move = [&](Eigen::Vector2d* pixel, Eigen::Vector3d* point) {
    pixel->x() += pixels * normal(random);
    pixel->y() += pixels * normal(random);
    *point = backProjectPoint(camera, *pixel, point->z());
  };
  for (SpatialMatch& match : *matches) {
    for (LiftedLine* line : {&match.first, &match.second}) {
      move(&line->pixel1, &line->point1);
      move(&line->pixel2, &line->point2);
    }
  }
}

/// Exchanges the second lines of a random `share` of the matches in a ring, so that each of them is
/// wrong. Returns which are.
inline std::vector<bool> makeWrong(double share, RandomLines* random, SpatialMatches* matches) {
  std::vector<std::size_t> order(matches->size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  random->shuffle(&order);
  const auto count =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(matches->size())));
  std::vector<bool> wrong(matches->size(), false);
  if (count < 2) {
    return wrong;
  }
  const LiftedLine spare = (*matches)[order[0]].second;
  for (std::size_t i = 0; i < count; ++i) {
    (*matches)[order[i]].second = i + 1 < count ? (*matches)[order[i + 1]].second : spare;
    wrong[order[i]] = true;
  }
  return wrong;
}

}  // namespace evolin::test
