// Distortion models against OpenCV's own, their inverses, and where they end.
#include "evolin_ros/geometry/lens_distortion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <string>
#include <vector>

#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

Camera lens(const std::string& model, std::vector<double> distortion) {
  Camera camera;
  camera.name = model;
  camera.distortion_model = model;
  camera.distortion = std::move(distortion);
  return camera;
}

/// Lenses as calibrations give them; the first three are those of well-known data sets.
std::vector<Camera> lenses() {
  return {
      lens("plumb_bob", {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}),
      lens("plumb_bob", {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}),
      lens("plumb_bob", {-0.40, 0.16, -0.002, 0.003, -0.03}),
      lens("rational_polynomial", {0.6, -1.2, 0.0004, -0.0003, 0.9, 0.45, -1.05, 0.75}),
      lens("rational_polynomial",
           {0.6, -1.2, 0.0004, -0.0003, 0.9, 0.45, -1.05, 0.75, 0.002, -0.001, 0.0015, 0.0005}),
      lens("rational_polynomial", {-0.1, 0.05, 0.0004, -0.0003, 0.01, 0.02, -0.01, 0.005, 0.002,
                                   -0.001, 0.0015, 0.0005, 0.02, -0.015}),
  };
}

cv::Point2d openCvDistorts(const Camera& camera, const Eigen::Vector2d& point) {
  std::vector<cv::Point2d> image;
  if (camera.distortion_model == "equidistant") {
    cv::fisheye::distortPoints(std::vector<cv::Point2d>{{point.x(), point.y()}}, image,
                               cv::Mat::eye(3, 3, CV_64F), camera.distortion);
  } else {
    cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), 1}}, cv::Vec3d(), cv::Vec3d(),
                      cv::Mat::eye(3, 3, CV_64F), camera.distortion, image);
  }
  return image.front();
}

void expectNear(const Eigen::Vector2d& a, double x, double y, double tolerance) {
  EXPECT_NEAR(a.x(), x, tolerance);
  EXPECT_NEAR(a.y(), y, tolerance);
}

TEST(LensDistortion, EqualsOpenCvs) {
  test::RandomLines random(1);
  std::vector<Camera> all = lenses();
  all.push_back(lens("equidistant", {-0.0134, 0.0207, -0.0126, 0.0026}));
  all.push_back(lens("equidistant", {0, 0, 0, 0}));
  for (const Camera& camera : all) {
    SCOPED_TRACE(camera.name + " of " + std::to_string(camera.distortion.size()));
    const LensDistortion distortion(camera);
    EXPECT_TRUE(distortion.isDistorted());
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d point(random.uniform(-0.55, 0.55), random.uniform(-0.4, 0.4));
      const auto distorted = distortion.distort(point);
      ASSERT_TRUE(distorted) << point.transpose();
      const cv::Point2d expected = openCvDistorts(camera, point);
      expectNear(*distorted, expected.x, expected.y, 1e-12);
    }
  }
}

TEST(LensDistortion, IsUndone) {
  test::RandomLines random(2);
  std::vector<Camera> all = lenses();
  all.push_back(lens("equidistant", {-0.0134, 0.0207, -0.0126, 0.0026}));
  double worst = 0;
  for (const Camera& camera : all) {
    SCOPED_TRACE(camera.name + " of " + std::to_string(camera.distortion.size()));
    const LensDistortion distortion(camera);
    for (int i = 0; i < 2000; ++i) {
      // Up to the edge of what the model reaches, the corners of a wide lens included.
      const double distance = std::min(1.2, 0.97 * distortion.reach()) * random.uniform(0, 1);
      const double angle = random.uniform(-M_PI, M_PI);
      const Eigen::Vector2d point(distance * std::cos(angle), distance * std::sin(angle));
      const auto distorted = distortion.distort(point);
      ASSERT_TRUE(distorted) << point.transpose();
      const auto back = distortion.undistort(*distorted);
      ASSERT_TRUE(back) << point.transpose() << ", reach " << distortion.reach();
      worst = std::max(worst, (*back - point).norm());
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst", std::to_string(worst));
}

TEST(LensDistortion, UndoesAFisheyeFarOffTheAxis) {
  const LensDistortion distortion(lens("equidistant", {-0.0134, 0.0207, -0.0126, 0.0026}));
  for (const double degrees : {1.0, 30.0, 60.0, 80.0, 85.0}) {
    const double distance = std::tan(degrees * M_PI / 180);
    const Eigen::Vector2d point(0.6 * distance, -0.8 * distance);
    const auto distorted = distortion.distort(point);
    ASSERT_TRUE(distorted) << degrees;
    const auto back = distortion.undistort(*distorted);
    ASSERT_TRUE(back) << degrees;
    EXPECT_LT((*back - point).norm(), 1e-9 * (1 + distance)) << degrees;
  }
}

TEST(LensDistortion, OfNoneIsTheIdentity) {
  for (const Camera& camera : {lens("plumb_bob", {}), lens("plumb_bob", {0, 0, 0, 0, 0}),
                               lens("equidistant", {}), lens("rational_polynomial", {})}) {
    const LensDistortion distortion(camera);
    EXPECT_FALSE(distortion.isDistorted());
    expectNear(distortion.distort({0.3, -20}).value(), 0.3, -20, 0);
    expectNear(distortion.undistort({0.3, -20}).value(), 0.3, -20, 0);
  }
}

TEST(LensDistortion, KeepsTheAxisWhereItBelongs) {
  for (const Camera& camera : lenses()) {
    const LensDistortion distortion(camera);
    const cv::Point2d expected = openCvDistorts(camera, {0, 0});
    expectNear(distortion.distort({0, 0}).value(), expected.x, expected.y, 1e-15);
    expectNear(distortion.undistort({expected.x, expected.y}).value(), 0, 0, 1e-12);
  }
}

TEST(LensDistortion, EndsWhereThePolynomialTurnsBack) {
  // r - 0.3 r^3 has its maximum at r = 1 / sqrt(0.9).
  const LensDistortion distortion(lens("plumb_bob", {-0.3, 0, 0, 0}));
  const double turn = 1 / std::sqrt(0.9);
  EXPECT_NEAR(distortion.reach(), turn, 1e-9);
  EXPECT_TRUE(distortion.distort({0.99 * turn, 0}));
  EXPECT_FALSE(distortion.distort({1.01 * turn, 0})) << "it would be seen inside";
  const double largest = turn - 0.3 * turn * turn * turn;
  EXPECT_TRUE(distortion.undistort({0, 0.999 * largest}));
  EXPECT_FALSE(distortion.undistort({0, 1.001 * largest}));
}

TEST(LensDistortion, HasNoImageOfWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Camera& camera :
       {lens("plumb_bob", {}), lenses()[1], lens("equidistant", {0, 0, 0, 0})}) {
    const LensDistortion distortion(camera);
    for (const double value : {nan, infinity, -infinity, 1e300}) {
      EXPECT_FALSE(distortion.distort({value, 0})) << camera.name << value;
      EXPECT_FALSE(distortion.undistort({0, value})) << camera.name << value;
    }
  }
}

TEST(LensDistortion, RefusesUnknownModels) {
  test::expectError([] { LensDistortion(lens("division", {0.1})); }, {"division", "plumb_bob"});
  test::expectError([] { LensDistortion(lens("plumb_bob", {0.1, 0.2})); }, {"2 coefficients"});
}

}  // namespace
}  // namespace evolin
