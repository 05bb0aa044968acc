// What a camera must be like before it is used.
#include "evolin_ros/geometry/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

Camera goodCamera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 500;
  camera.fy = 501;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

std::string messageFor(const Camera& camera) {
  try {
    validateCamera(camera, "camera.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ValidateCamera, AcceptsANegativeFocalLength) {
  Camera camera = goodCamera();
  camera.fy = -480;
  EXPECT_NO_THROW(validateCamera(camera, "icl"));
}

TEST(ValidateCamera, RefusesAZeroFocalLengthByName) {
  Camera camera = goodCamera();
  camera.fy = 0;
  const std::string message = messageFor(camera);
  EXPECT_TRUE(contains(message, "camera.yaml")) << message;
  EXPECT_TRUE(contains(message, "focal length fy is 0")) << message;
}

TEST(ValidateCamera, RefusesNumbersThatAreNotFinite) {
  for (double Camera::*member :
       {&Camera::fx, &Camera::fy, &Camera::cx, &Camera::cy, &Camera::depth_factor}) {
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Camera camera = goodCamera();
      camera.*member = value;
      EXPECT_TRUE(contains(messageFor(camera), "finite")) << messageFor(camera);
    }
  }
}

TEST(ValidateCamera, RefusesAnImageSizeThatIsNotPositive) {
  Camera camera = goodCamera();
  camera.height = 0;
  EXPECT_TRUE(contains(messageFor(camera), "640 x 0")) << messageFor(camera);
}

TEST(ValidateCamera, RefusesADepthFactorThatIsNotPositive) {
  Camera camera = goodCamera();
  camera.depth_factor = -1;
  EXPECT_TRUE(contains(messageFor(camera), "depth_factor is -1")) << messageFor(camera);
}

TEST(ValidateCamera, NamesTheKnownDistortionModels) {
  Camera camera = goodCamera();
  camera.distortion_model = "fisheye";
  const std::string message = messageFor(camera);
  EXPECT_TRUE(contains(message, "fisheye")) << message;
  EXPECT_TRUE(contains(message, "equidistant")) << message;
}

TEST(ValidateCamera, CountsTheCoefficientsOfEachModel) {
  const struct {
    const char* model;
    std::size_t count;
    bool good;
  } cases[] = {{"plumb_bob", 0, true},   {"plumb_bob", 4, true},
               {"plumb_bob", 5, true},   {"plumb_bob", 3, false},
               {"plumb_bob", 8, false},  {"rational_polynomial", 8, true},
               {"equidistant", 4, true}, {"rational_polynomial", 5, false},
               {"equidistant", 5, false}};
  for (const auto& given : cases) {
    Camera camera = goodCamera();
    camera.distortion_model = given.model;
    camera.distortion.assign(given.count, 0.1);
    const std::string message = messageFor(camera);
    EXPECT_EQ(message == "no error", given.good) << given.model << " " << given.count;
    if (!given.good) {
      EXPECT_TRUE(contains(message, std::to_string(given.count))) << message;
    }
  }
}

TEST(HasDistortion, IsFalseForZerosButOfAnEquidistantLens) {
  Camera camera = goodCamera();
  EXPECT_FALSE(hasDistortion(camera));
  camera.distortion = {0, 0, 0, 0, 0};
  EXPECT_FALSE(hasDistortion(camera));
  camera.distortion[3] = -1e-9;
  EXPECT_TRUE(hasDistortion(camera));
  camera.distortion_model = "equidistant";
  camera.distortion = {0, 0, 0, 0};
  EXPECT_TRUE(hasDistortion(camera));
  camera.distortion.clear();
  EXPECT_FALSE(hasDistortion(camera));
}

TEST(SameIntrinsics, LooksAtTheRaysAndTheSizeAlone) {
  const Camera camera = goodCamera();
  Camera other = camera;
  other.name = "another";
  other.depth_factor = 1000;
  other.distortion_model = "equidistant";
  EXPECT_TRUE(sameIntrinsics(camera, other));
  other = camera;
  other.distortion = {0, 0, 0, 0};
  EXPECT_TRUE(sameIntrinsics(camera, other)) << "neither moves anything";
  other.distortion = {0, 0.1, 0, 0};
  EXPECT_FALSE(sameIntrinsics(camera, other));
  for (double Camera::*member : {&Camera::fx, &Camera::fy, &Camera::cx, &Camera::cy}) {
    other = camera;
    other.*member += 1e-9;
    EXPECT_FALSE(sameIntrinsics(camera, other));
  }
  for (int Camera::*member : {&Camera::width, &Camera::height}) {
    other = camera;
    other.*member += 1;
    EXPECT_FALSE(sameIntrinsics(other, camera));
  }
}

}  // namespace
}  // namespace evolin
