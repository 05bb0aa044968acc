// Polynomials of lenses; inversion by bisection of the radial part, which is monotone within the
// reach, and Newton's method for the rest.
#include "evolin_ros/geometry/lens_distortion.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evolin {

namespace {

/// Rotation of a tilted sensor by two angles (radians) and its perspective, as in OpenCV's
/// documentation of calib3d.
Eigen::Matrix3d tiltOf(double about_x, double about_y) {
  const double cx = std::cos(about_x);
  const double sx = std::sin(about_x);
  const double cy = std::cos(about_y);
  const double sy = std::sin(about_y);
  Eigen::Matrix3d x;
  x << 1, 0, 0, 0, cx, sx, 0, -sx, cx;
  Eigen::Matrix3d y;
  y << cy, 0, -sy, 0, 1, 0, sy, 0, cy;
  const Eigen::Matrix3d rotation = y * x;
  Eigen::Matrix3d onto_plane = Eigen::Matrix3d::Identity();
  onto_plane(0, 0) = onto_plane(1, 1) = rotation(2, 2);
  onto_plane(0, 2) = -rotation(0, 2);
  onto_plane(1, 2) = -rotation(1, 2);
  return onto_plane * rotation;
}

}  // namespace

LensDistortion::LensDistortion(const Camera& camera) {
  Camera checked = camera;
  checked.width = checked.height = 1;
  checked.fx = checked.fy = 1;
  checked.cx = checked.cy = 0;
  checked.depth_factor = 1;
  validateCamera(checked, "camera " + camera.name);
  std::copy(camera.distortion.begin(), camera.distortion.end(), d_.begin());
  if (!hasDistortion(camera)) {
    return;
  }
  if (camera.distortion_model == "equidistant") {
    model_ = Model::kEquidistant;
  } else {
    model_ = Model::kPolynomial;
    tilt_ = tiltOf(d_[12], d_[13]);
    untilt_ = tilt_.inverse();
  }
  end_ = findReach();
  reach_ = model_ == Model::kEquidistant ? std::tan(end_) : end_;
}

LensDistortion::Slope LensDistortion::radialFactor(double squared) const {
  const double u = squared;
  const double above = 1 + u * (d_[0] + u * (d_[1] + u * d_[4]));
  const double above_slope = d_[0] + u * (2 * d_[1] + u * 3 * d_[4]);
  const double below = 1 + u * (d_[5] + u * (d_[6] + u * d_[7]));
  const double below_slope = d_[5] + u * (2 * d_[6] + u * 3 * d_[7]);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

LensDistortion::Slope LensDistortion::radial(double at) const {
  const double u = at * at;
  if (model_ == Model::kEquidistant) {
    return {at * (1 + u * (d_[0] + u * (d_[1] + u * (d_[2] + u * d_[3])))),
            1 + u * (3 * d_[0] + u * (5 * d_[1] + u * (7 * d_[2] + u * 9 * d_[3])))};
  }
  const Slope factor = radialFactor(u);
  return {at * factor.value, factor.value + 2 * u * factor.derivative};
}

double LensDistortion::findReach() const {
  constexpr int kSteps = 2000;
  const double farthest = std::atan(kFarthest);
  // Angles are even steps over the field of view for both kinds of models.
  const auto argument = [this](double angle) {
    return model_ == Model::kEquidistant ? angle : std::tan(angle);
  };
  const auto grows = [&](double angle) {
    const Slope slope = radial(argument(angle));
    return slope.derivative > 0 && slope.value >= 0;
  };
  for (int step = 1; step <= kSteps; ++step) {
    double turned = farthest * step / kSteps;
    if (grows(turned)) {
      continue;
    }
    double growing = farthest * (step - 1) / kSteps;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (growing + turned) / 2;
      (grows(middle) ? growing : turned) = middle;
    }
    return argument(growing);
  }
  return argument(farthest);
}

double LensDistortion::invertRadial(double distorted) const {
  double low = 0;
  double high = end_;
  for (int halving = 0; halving < 100 && low < high; ++halving) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) {
      break;
    }
    (radial(middle).value < distorted ? low : high) = middle;
  }
  return (low + high) / 2;
}

Eigen::Vector2d LensDistortion::bend(const Eigen::Vector2d& point,
                                     Eigen::Matrix2d* jacobian) const {
  const double x = point.x();
  const double y = point.y();
  const double u = point.squaredNorm();
  const Slope factor = radialFactor(u);
  const double p1 = d_[2];
  const double p2 = d_[3];
  const double prism_x_slope = d_[8] + 2 * d_[9] * u;
  const double prism_y_slope = d_[10] + 2 * d_[11] * u;
  if (jacobian != nullptr) {
    *jacobian << factor.value + 2 * x * x * factor.derivative + 2 * p1 * y + 6 * p2 * x +
                     2 * x * prism_x_slope,
        2 * x * y * factor.derivative + 2 * p1 * x + 2 * p2 * y + 2 * y * prism_x_slope,
        2 * x * y * factor.derivative + 2 * p1 * x + 2 * p2 * y + 2 * x * prism_y_slope,
        factor.value + 2 * y * y * factor.derivative + 6 * p1 * y + 2 * p2 * x +
            2 * y * prism_y_slope;
  }
  return {x * factor.value + 2 * p1 * x * y + p2 * (u + 2 * x * x) + u * (d_[8] + u * d_[9]),
          y * factor.value + p1 * (u + 2 * y * y) + 2 * p2 * x * y + u * (d_[10] + u * d_[11])};
}

std::optional<Eigen::Vector2d> LensDistortion::distort(const Eigen::Vector2d& point) const {
  const double distance = point.norm();
  if (!std::isfinite(distance) || distance > reach_) {
    return std::nullopt;
  }
  if (model_ == Model::kNone || distance == 0) {
    return model_ == Model::kPolynomial
               ? Eigen::Vector2d((tilt_ * point.homogeneous()).hnormalized())
               : point;
  }
  if (model_ == Model::kEquidistant) {
    return Eigen::Vector2d(point * (radial(std::atan(distance)).value / distance));
  }
  const Eigen::Vector3d tilted = tilt_ * bend(point, nullptr).homogeneous();
  return tilted.z() > 0 ? std::optional<Eigen::Vector2d>(tilted.hnormalized()) : std::nullopt;
}

std::optional<Eigen::Vector2d> LensDistortion::undistort(const Eigen::Vector2d& distorted) const {
  const double distance = distorted.norm();
  if (!std::isfinite(distance)) {
    return std::nullopt;
  }
  if (model_ == Model::kNone) {
    return distance > reach_ ? std::nullopt : std::optional<Eigen::Vector2d>(distorted);
  }
  if (model_ == Model::kPolynomial) {
    const Eigen::Vector3d upright = untilt_ * distorted.homogeneous();
    return upright.z() > 0 ? unbend(upright.hnormalized()) : std::nullopt;
  }
  if (distance > radial(end_).value) {
    return std::nullopt;
  }
  return distance == 0 ? distorted
                       : Eigen::Vector2d(distorted * (std::tan(invertRadial(distance)) / distance));
}

std::optional<Eigen::Vector2d> LensDistortion::unbend(const Eigen::Vector2d& bent) const {
  const double distance = bent.norm();
  // Prism and tangential terms move even the point on the axis, but not far.
  Eigen::Vector2d point =
      distance == 0 ? bent : Eigen::Vector2d(bent * (invertRadial(distance) / distance));
  Eigen::Matrix2d jacobian;
  Eigen::Vector2d residual = bend(point, &jacobian) - bent;
  for (int round = 0; round < 50 && residual.norm() > 0; ++round) {
    const double determinant = jacobian.determinant();
    if (!(std::abs(determinant) > 1e-12)) {
      break;
    }
    const Eigen::Vector2d step = jacobian.inverse() * residual;
    // Half steps where a whole one goes too far; none where rounding is all that is left.
    double share = 1;
    Eigen::Vector2d next = point - step;
    while (share > 1e-3 && !((bend(next, nullptr) - bent).norm() < residual.norm())) {
      share /= 2;
      next = point - share * step;
    }
    const Eigen::Vector2d remaining = bend(next, &jacobian) - bent;
    if (!(remaining.norm() < residual.norm())) {
      break;
    }
    point = next;
    residual = remaining;
  }
  const bool solved = residual.norm() <= 1e-12 * (1 + distance) && point.norm() <= reach_;
  return solved && jacobian.determinant() > 0 ? std::optional<Eigen::Vector2d>(point)
                                              : std::nullopt;
}

}  // namespace evolin
