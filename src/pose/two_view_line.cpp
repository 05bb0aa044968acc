// Distances of a match in both images with their derivatives.
#include "two_view_line.h"

#include <cmath>
#include <limits>

#include "line_residual.h"

namespace evolin {

std::vector<TwoViewLine> makeTwoViewLines(const SpatialMatches& matches) {
  std::vector<TwoViewLine> lines;
  lines.reserve(matches.size());
  for (std::size_t place = 0; place < matches.size(); ++place) {
    const LiftedLine& first = matches[place].first;
    const LiftedLine& second = matches[place].second;
    TwoViewLine line;
    line.forward = {{first.point1, first.point2}, imageLine(second, true)};
    line.backward = {{second.point1, second.point2}, imageLine(first, true)};
    line.direction1 = (first.point2 - first.point1).stableNormalized();
    line.direction2 = (second.point2 - second.point1).stableNormalized();
    line.lengths = {(first.pixel2 - first.pixel1).norm(), (second.pixel2 - second.pixel1).norm()};
    line.place = place;
    const bool finite = line.forward.line.allFinite() && line.backward.line.allFinite() &&
                        first.point1.allFinite() && first.point2.allFinite() &&
                        second.point1.allFinite() && second.point2.allFinite();
    if (finite && line.direction1.squaredNorm() > 0 && line.direction2.squaredNorm() > 0) {
      lines.push_back(line);
    }
  }
  return lines;
}

double squaredDistance(const PointsOnLine& seen, const Eigen::Matrix3d& rotation,
                       const Eigen::Vector3d& translation, const Camera& camera) {
  double sum = 0;
  for (const Eigen::Vector3d& point : seen.points) {
    const Eigen::Vector3d moved = rotation * point + translation;
    if (!(moved.z() > 0)) {
      return std::numeric_limits<double>::infinity();
    }
    const double distance = lineResidual(seen.line, camera, moved);
    sum += distance * distance;
  }
  return sum / 2;
}

bool lineariseForward(const TwoViewLine& line, const Pose& motion, const Camera& camera,
                      LinearisedDistances* result) {
  for (int end = 0; end < 2; ++end) {
    const Eigen::Vector3d point =
        motion.rotation * line.forward.points[static_cast<std::size_t>(end)] + motion.translation;
    if (!(point.z() > 0)) {
      return false;
    }
    result->values[end] = lineResidual(line.forward.line, camera, point);
    result->jacobian.row(end) =
        lineResidualJacobian(point, lineResidualGradient(line.forward.line, camera, point));
  }
  return true;
}

bool lineariseBackward(const TwoViewLine& line, const Pose& motion, const Camera& camera,
                       LinearisedDistances* result) {
  const Eigen::Quaterniond back = motion.rotation.conjugate();
  for (int end = 0; end < 2; ++end) {
    const Eigen::Vector3d& target = line.backward.points[static_cast<std::size_t>(end)];
    const Eigen::Vector3d point = back * (target - motion.translation);
    if (!(point.z() > 0)) {
      return false;
    }
    result->values[end] = lineResidual(line.backward.line, camera, point);
    // exp(d) before the inverse moves the target by -d.
    const Eigen::Vector3d gradient =
        motion.rotation * lineResidualGradient(line.backward.line, camera, point);
    result->jacobian.row(end) = -lineResidualJacobian(target, gradient);
  }
  return true;
}

WeightedEquations sumEquations(const std::vector<TwoViewLine>& lines,
                               const std::vector<Support>& use, const Pose& motion,
                               const Camera& camera, double scale) {
  WeightedEquations sum;
  LinearisedDistances part;
  const auto add = [&] {
    const double weight =
        std::isinf(scale) ? 1.0 : 1 / (1 + part.values.squaredNorm() / (scale * scale));
    sum.hessian.noalias() += weight * part.jacobian.transpose() * part.jacobian;
    sum.right_side.noalias() -= weight * part.jacobian.transpose() * part.values;
    sum.weighted_squares += weight * part.values.squaredNorm();
    sum.weights += 2 * weight;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (use[i].forward && lineariseForward(lines[i], motion, camera, &part)) {
      add();
    }
    if (use[i].backward && lineariseBackward(lines[i], motion, camera, &part)) {
      add();
    }
  }
  return sum;
}

}  // namespace evolin
