// Views of images from camera_info: distorted, rectified, cut, binned, uncalibrated.
#include "adapter_camera.h"

#include <gtest/gtest.h>
#include <sensor_msgs/distortion_models.h>

#include "conversions.h"
#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

using test::expectError;

sensor_msgs::CameraInfo info() {
  sensor_msgs::CameraInfo message;
  message.header.frame_id = "/cam0";
  message.width = 640;
  message.height = 480;
  message.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  message.D = {-0.28, 0.07, 0.0002, 0.00002, 0};
  message.K = {450, 0, 320, 0, 455, 240, 0, 0, 1};
  // Turned by a little about y, other focal lengths: as stereo calibrations have it.
  message.R = {0.8, 0, 0.6, 0, 1, 0, -0.6, 0, 0.8};
  message.P = {400, 0, 330, -40, 0, 400, 250, 0, 0, 0, 1, 0};
  return message;
}

void expectPixel(const ImageView& view, const Eigen::Vector2d& normalized, double x, double y) {
  const auto pixel = view.pixelOf(normalized);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), x, 1e-9);
  EXPECT_NEAR(pixel->y(), y, 1e-9);
}

TEST(AdapterCamera, ViewsRawImagesThroughTheLens) {
  const AdapterView view = viewOf(info(), AdapterPixels::kDistorted);
  EXPECT_EQ(view.frame_id, "cam0");
  const ImageView expected = ImageView::distorted(fromMessage(info()));
  const Eigen::Vector2d pixel = expected.pixelOf({0.3, -0.2}).value();
  expectPixel(view.view, {0.3, -0.2}, pixel.x(), pixel.y());
  EXPECT_GT((pixel - Eigen::Vector2d(450 * 0.3 + 320, 240 - 455 * 0.2)).norm(), 2) << "it bends";
}

TEST(AdapterCamera, ViewsRectifiedImagesByPAndR) {
  const AdapterView view = viewOf(info(), AdapterPixels::kRectified);
  // R (0.5, 0.2, 1) = (0.8 * 0.5 + 0.6, 0.2, -0.6 * 0.5 + 0.8) = (1, 0.2, 0.5).
  expectPixel(view.view, {0.5, 0.2}, 400 * 2 + 330, 400 * 0.4 + 250);
}

TEST(AdapterCamera, TakesKForRectifiedImagesWherePIsEmpty) {
  sensor_msgs::CameraInfo message = info();
  message.P.fill(0);
  message.R.fill(0);
  expectPixel(viewOf(message, AdapterPixels::kRectified).view, {0.5, 0.2}, 545, 331);
}

TEST(AdapterCamera, AppliesRegionAndBinningToBoth) {
  sensor_msgs::CameraInfo message = info();
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.roi.x_offset = 100;
  message.roi.y_offset = 50;
  message.roi.width = 400;
  message.roi.height = 300;
  message.binning_x = message.binning_y = 2;
  const ImageView rectified = viewOf(message, AdapterPixels::kRectified).view;
  EXPECT_EQ(rectified.size().width, 200);
  EXPECT_EQ(rectified.size().height, 150);
  expectPixel(rectified, {0.5, 0.2}, (400 * 0.5 + 330 - 100) / 2, (400 * 0.2 + 250 - 50) / 2);
  const Eigen::Vector2d whole = ImageView::distorted(fromMessage(info())).pixelOf({0.3, 0}).value();
  expectPixel(viewOf(message, AdapterPixels::kDistorted).view, {0.3, 0}, (whole.x() - 100) / 2,
              (whole.y() - 50) / 2);
}

TEST(AdapterCamera, RefusesUncalibratedOnesUnlessTheSizeIsEnough) {
  sensor_msgs::CameraInfo message = info();
  message.K.fill(0);
  expectError([&] { viewOf(message, AdapterPixels::kDistorted); }, {"uncalibrated"});
  EXPECT_EQ(viewOf(message, AdapterPixels::kSizeOnly).view.size().width, 640);
  EXPECT_EQ(viewOf(message, AdapterPixels::kSizeOnly).frame_id, "cam0");
  message.width = 0;
  expectError([&] { viewOf(message, AdapterPixels::kSizeOnly); }, {"0 x 480"});
  message = info();
  message.distortion_model = "fov";
  expectError([&] { viewOf(message, AdapterPixels::kDistorted); }, {"fov", "equidistant"});
}

TEST(AdapterCamera, KnowsItsWords) {
  EXPECT_EQ(parsePixels("distorted"), AdapterPixels::kDistorted);
  EXPECT_EQ(parsePixels("rectified"), AdapterPixels::kRectified);
  expectError([] { parsePixels("undistorted"); }, {"'undistorted'", "rectified"});
}

}  // namespace
}  // namespace evolin::ros_shell
