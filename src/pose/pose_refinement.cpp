// Refinement with Ceres (Agarwal, Mierle and others): sum over views of c^2 log(1 + (a^2 + b^2) /
// c^2) with a, b the distances of a view's two points. Ceres 2.1 renamed local parameterisations to
// manifolds and 2.2 dropped the old name; both are served.
#include "pose_refinement.h"

#include <ceres/ceres.h>
#include <ceres/version.h>

#include <algorithm>
#include <array>

#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
#define EVOLIN_CERES_HAS_MANIFOLD 1
#include <ceres/manifold.h>
#else
#define EVOLIN_CERES_HAS_MANIFOLD 0
#include <ceres/local_parameterization.h>
#endif

namespace evolin {

namespace {

constexpr int kStored = 7;  // quaternion x y z w, translation
constexpr int kFree = 6;

using Block = std::array<double, kStored>;
using StoredJacobian = Eigen::Matrix<double, kStored, kFree, Eigen::RowMajor>;

Pose toPose(const double* block) {
  Pose pose;
  pose.rotation.coeffs() = Eigen::Map<const Eigen::Vector4d>(block);
  pose.translation = Eigen::Map<const Eigen::Vector3d>(block + 4);
  return pose;
}

void store(const Pose& pose, double* block) {
  Eigen::Map<Eigen::Matrix<double, kStored, 1>> stored(block);
  stored << pose.rotation.coeffs(), pose.translation;
}

void step(const double* block, const double* delta, double* moved) {
  store(compose(expMotion(Eigen::Map<const Vector6d>(delta)), toPose(block)), moved);
}

// The costs differentiate by the step itself and leave the result in the first six columns; the
// change from stored to free parameters is then the identity.
void setStepJacobian(double* jacobian) { Eigen::Map<StoredJacobian>(jacobian).setIdentity(); }

#if EVOLIN_CERES_HAS_MANIFOLD
class Motions final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kStored; }
  int TangentSize() const override { return kFree; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    step(x, delta, x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    setStepJacobian(jacobian);
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d> difference(y_minus_x);
    difference = logMotion(compose(toPose(y), inverse(toPose(x))));
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* values) const override {
    Eigen::Map<Eigen::Matrix<double, kFree, kStored, Eigen::RowMajor>> jacobian(values);
    jacobian.setIdentity();
    return true;
  }
};
#else
class Motions final : public ceres::LocalParameterization {
 public:
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    step(x, delta, x_plus_delta);
    return true;
  }
  bool ComputeJacobian(const double* /*x*/, double* jacobian) const override {
    setStepJacobian(jacobian);
    return true;
  }
  int GlobalSize() const override { return kStored; }
  int LocalSize() const override { return kFree; }
};
#endif

using Linearise = bool (*)(const TwoViewLine&, const Pose&, const Camera&, LinearisedDistances*);

class ViewCost final : public ceres::SizedCostFunction<2, kStored> {
 public:
  ViewCost(const TwoViewLine& line, const Camera& camera, Linearise linearise)
      : line_(line), camera_(camera), linearise_(linearise) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    LinearisedDistances distances;
    if (!linearise_(line_, toPose(parameters[0]), camera_, &distances)) {
      return false;  // a point behind the camera: no such step
    }
    std::copy_n(distances.values.data(), 2, residuals);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, kStored, Eigen::RowMajor>> jacobian(jacobians[0]);
      jacobian.leftCols<kFree>() = distances.jacobian;
      jacobian.col(kFree).setZero();
    }
    return true;
  }

 private:
  const TwoViewLine& line_;
  const Camera& camera_;
  Linearise linearise_;
};

}  // namespace

Refinement refineMotion(const std::vector<TwoViewLine>& lines, const std::vector<Support>& support,
                        const Pose& start, const Camera& camera, double loss_scale, int max_steps) {
  Refinement result;
  result.motion = start;
  Block block{};
  store(start, block.data());

  ceres::CauchyLoss loss(loss_scale);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem problem(problem_options);
#if EVOLIN_CERES_HAS_MANIFOLD
  problem.AddParameterBlock(block.data(), kStored);
  problem.SetManifold(block.data(), new Motions);
#else
  problem.AddParameterBlock(block.data(), kStored, new Motions);
#endif
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (support[i].forward) {
      problem.AddResidualBlock(new ViewCost(lines[i], camera, lineariseForward), &loss,
                               block.data());
    }
    if (support[i].backward) {
      problem.AddResidualBlock(new ViewCost(lines[i], camera, lineariseBackward), &loss,
                               block.data());
    }
  }
  if (problem.NumResidualBlocks() == 0) {
    return result;
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_steps;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-10;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size());
  const Pose refined = toPose(block.data());
  if (summary.IsSolutionUsable() && isFinite(refined)) {
    result.motion = refined;
    result.usable = true;
  }
  return result;
}

}  // namespace evolin
