// Views of images: pixels of directions, and the visible part of segments in space.
#include "evolin_ros/geometry/image_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

Camera wide(double bend) {
  Camera camera;
  camera.name = "wide";
  camera.width = 640;
  camera.height = 480;
  camera.fx = 380;
  camera.fy = 382;
  camera.cx = 321.5;
  camera.cy = 236;
  if (bend != 0) {
    camera.distortion = {bend, 0.05, 0.0003, -0.0002};
  }
  return camera;
}

Segment3d between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return {a, b}; }

void expectSegment(const std::optional<LineSegment>& line, double x1, double y1, double x2,
                   double y2, double tolerance) {
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->x1, x1, tolerance);
  EXPECT_NEAR(line->y1, y1, tolerance);
  EXPECT_NEAR(line->x2, x2, tolerance);
  EXPECT_NEAR(line->y2, y2, tolerance);
}

TEST(ImageView, OfAPinholeIsTheMatrix) {
  const ImageView view = ImageView::distorted(wide(0));
  const Eigen::Vector2d pixel = view.pixelOf({0.25, -0.5}).value();
  EXPECT_EQ(pixel, Eigen::Vector2d(380 * 0.25 + 321.5, 236 - 382 * 0.5));
  EXPECT_LT((view.normalizedOf(pixel).value() - Eigen::Vector2d(0.25, -0.5)).norm(), 1e-15);
  EXPECT_EQ(view.size().width, 640);
}

TEST(ImageView, GoesThereAndBack) {
  test::RandomLines random(3);
  Eigen::Matrix3d turn;
  turn = Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, -1).normalized());
  for (const ImageView& view :
       {ImageView::distorted(wide(-0.2)), ImageView::rectified(wide(-0.2), turn)}) {
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d pixel(random.uniform(0, 639), random.uniform(0, 479));
      const auto normalized = view.normalizedOf(pixel);
      ASSERT_TRUE(normalized);
      EXPECT_LT((view.pixelOf(*normalized).value() - pixel).norm(), 1e-9);
    }
  }
}

TEST(ImageView, OfRectifiedImagesTurnsDirections) {
  Eigen::Matrix3d quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const ImageView view = ImageView::rectified(wide(-0.2), quarter);
  // x goes to y: what lies to the right is seen below.
  EXPECT_LT((view.pixelOf({0.5, 0}).value() - Eigen::Vector2d(321.5, 236 + 191)).norm(), 1e-12);
  Eigen::Matrix3d back;
  back = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY());
  EXPECT_FALSE(ImageView::rectified(wide(0), back).pixelOf({0, 0}));
}

TEST(ImageView, ProjectsWholeSegmentsUnchanged) {
  const ImageView view = ImageView::distorted(wide(0));
  expectSegment(view.project(between({-1, 0.5, 2}, {0.5, -1, 4}), 0.05), 321.5 - 190,
                236 + 382 * 0.25, 321.5 + 380 * 0.125, 236 - 382 * 0.25, 1e-9);
}

TEST(ImageView, CutsAtTheBorderAndBeforeTheCamera) {
  const ImageView view = ImageView::distorted(wide(0));
  // From far to the left through the axis to far to the right.
  expectSegment(view.project(between({-100, 0, 2}, {100, 0, 2}), 0.05), 0, 236, 639, 236, 1e-9);
  // Towards the camera and past it, below it: the line's image goes down to the border.
  expectSegment(view.project(between({0, 1, 10}, {0, 1, -10}), 0.05), 321.5, 236 + 38.2, 321.5, 479,
                1e-9);
  EXPECT_FALSE(view.project(between({0, 0, -1}, {1, 0, -2}), 0.05)) << "behind the camera";
  EXPECT_FALSE(view.project(between({-5, -5, 1}, {5, -5, 1}), 0.05)) << "above the image";
  EXPECT_FALSE(view.project(between({0, 0, NAN}, {1, 0, 2}), 0.05));
  const auto corner = view.project(between({-14.5, 0, 10}, {0, -11, 10}), 0.05);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->x1, 0, 1e-9);
  EXPECT_NEAR(corner->y2, 0, 1e-9);
  EXPECT_FALSE(view.project(between({-17, 0, 10}, {0, -15, 10}), 0.05)) << "past the corner";
}

TEST(ImageView, EndsABentLineWhereItsCurveLeavesTheImage) {
  const Camera camera = wide(-0.25);
  const ImageView view = ImageView::distorted(camera);
  const Segment3d segment = between({-3, 0.9, 2}, {3, 0.9, 2});
  const auto line = view.project(segment, 0.05);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->x1, 0, 1e-6);
  EXPECT_NEAR(line->x2, 639, 1e-6);
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(line->x1, line->y1), Eigen::Vector2d(line->x2, line->y2)}) {
    EXPECT_NEAR(view.normalizedOf(pixel).value().y(), 0.45, 1e-9) << "on the line itself";
  }
}

TEST(ImageView, NeverShowsWhatTheLensModelFoldsBack) {
  Camera camera = wide(0);
  camera.distortion = {-0.3, 0, 0, 0};
  // At 70 degrees off the axis the polynomial would put it into the image again.
  EXPECT_FALSE(ImageView::distorted(camera).project(between({2.7, 0, 1}, {2.8, 0.3, 1}), 0.05));
}

TEST(ImageView, RefusesCamerasWithoutIntrinsics) {
  Camera camera = wide(0);
  camera.fx = 0;
  test::expectError([&] { ImageView::distorted(camera); }, {"fx", "not calibrated"});
}

}  // namespace
}  // namespace evolin
