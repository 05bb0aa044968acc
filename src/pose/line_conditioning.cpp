// The spread of the interpretation planes' normals, and the covariance at one pixel of noise.
#include "line_conditioning.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace evolin {

namespace {

/// Sums over supported views of lines, each weighted by how well its plane is known: by the inverse
/// of the variance that a pixel of noise gives the normal's turn about an axis in the plane.
struct Spread {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  ///< sum of weighted n n^T
  double weights = 0;
  double count = 0;

  Spread& operator+=(const Spread& other) {
    normals += other.normals;
    weights += other.weights;
    count += other.count;
    return *this;
  }

  Spread operator-(const Spread& other) const {
    return {normals - other.normals, weights - other.weights, count - other.count};
  }

  bool spansSpace() const {
    // Along a direction in all planes noise alone adds up to `count`: two standard deviations of
    // it, and never less than a degree or so.
    constexpr double kNoiseFactor = 4;
    constexpr double kFloor = 0.02 * 0.02;
    if (count < 3) {
      return false;
    }
    const double smallest =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normals, Eigen::EigenvaluesOnly)
            .eigenvalues()[0];
    return smallest > std::max(kFloor * weights, kNoiseFactor * count);
  }
};

/// Of the plane through the camera's centre and the image line, unit norm.
Eigen::Vector3d planeNormal(const Eigen::Vector3d& line, const Camera& camera) {
  return Eigen::Vector3d(camera.fx * line.x(), camera.fy * line.y(),
                         camera.cx * line.x() + camera.cy * line.y() + line.z())
      .normalized();
}

Spread spreadOfView(const Eigen::Vector3d& normal, double length, const Camera& camera) {
  // The ends' noise across the segment over its length, in the unit of the focal length.
  const double pixel = 1 / std::min(std::abs(camera.fx), std::abs(camera.fy));
  const double turn = std::max(std::sqrt(2.0) / length, pixel);
  const double weight = 1 / (turn * turn);
  return {weight * normal * normal.transpose(), weight, 1};
}

Spread spreadOf(const TwoViewLine& line, const Support& support, const Pose& motion,
                const Camera& camera) {
  Spread spread;
  if (support.forward) {
    spread += spreadOfView(planeNormal(line.forward.line, camera), line.lengths[1], camera);
  }
  if (support.backward) {
    spread += spreadOfView(motion.rotation * planeNormal(line.backward.line, camera),
                           line.lengths[0], camera);
  }
  return spread;
}

double medianDepth(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support) {
  std::vector<double> depths;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (support[i].any()) {
      depths.push_back((lines[i].forward.points[0].z() + lines[i].forward.points[1].z()) / 2);
    }
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

std::string openMotion(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                       const Pose& motion, const Camera& camera) {
  std::vector<Spread> parts;
  Spread all;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (support[i].any()) {
      parts.push_back(spreadOf(lines[i], support[i], motion, camera));
      all += parts.back();
    }
  }
  const std::string counted = std::to_string(parts.size());
  if (parts.size() < 3) {
    return counted + " agreeing lines, expected at least 3";
  }
  if (!all.spansSpace()) {
    return "the " + counted +
           " agreeing lines are parallel, pass through one point or lie in one plane with the "
           "camera: a translation stays open";
  }

  constexpr double kLargestRotation = 5 * 3.14159265358979323846 / 180;
  constexpr double kLargestTranslation = 0.1;
  const Matrix6d hessian =
      sumEquations(lines, support, motion, camera, std::numeric_limits<double>::infinity()).hessian;
  const Eigen::LLT<Matrix6d> factor(hessian);
  const Matrix6d covariance = factor.solve(Matrix6d::Identity());
  const double rotation = std::sqrt(covariance.diagonal().head<3>().maxCoeff());
  const double translation = std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
  if (factor.info() != Eigen::Success || !(rotation < kLargestRotation) ||
      !(translation < kLargestTranslation * medianDepth(lines, support))) {
    return "the " + counted +
           " agreeing lines leave the motion open: a pixel of noise moves it by more than 5 "
           "degrees "
           "or a tenth of their distance";
  }
  return "";
}

bool hangsOnOneLine(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                    const Pose& motion, const Camera& camera) {
  std::vector<Spread> parts;
  Spread all;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (support[i].any()) {
      parts.push_back(spreadOf(lines[i], support[i], motion, camera));
      all += parts.back();
    }
  }
  return std::any_of(parts.begin(), parts.end(),
                     [&all](const Spread& part) { return !(all - part).spansSpace(); });
}

}  // namespace evolin
