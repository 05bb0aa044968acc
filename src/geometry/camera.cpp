// The checks that intrinsics pass before anything is computed with them.
#include "evolin_ros/geometry/camera.h"

#include <algorithm>
#include <cmath>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

struct DistortionModel {
  const char* name;
  std::vector<std::size_t> coefficients;  ///< accepted numbers of them besides none
};

const std::vector<DistortionModel>& distortionModels() {
  static const std::vector<DistortionModel> kModels = {
      {"plumb_bob", {4, 5}}, {"rational_polynomial", {8, 12, 14}}, {"equidistant", {4}}};
  return kModels;
}

void requireFinite(const std::string& source, const std::string& key, double value) {
  if (!std::isfinite(value)) {
    throw Error(source + ": " + key + " is " + formatDouble(value) + ", expected a finite number");
  }
}

void requireFocalLength(const std::string& source, const std::string& key, double value) {
  requireFinite(source, key, value);
  if (value == 0) {
    throw Error(source + ": focal length " + key +
                " is 0, expected a number of pixels other than 0 (the camera is not calibrated)");
  }
}

void requireKnownDistortion(const std::string& source, const Camera& camera) {
  const std::vector<DistortionModel>& models = distortionModels();
  const auto model = std::find_if(models.begin(), models.end(), [&](const DistortionModel& known) {
    return known.name == camera.distortion_model;
  });
  if (model == models.end()) {
    throw Error(source + ": distortion_model is " + quote(camera.distortion_model) +
                ", expected plumb_bob, rational_polynomial or equidistant");
  }
  for (const double coefficient : camera.distortion) {
    requireFinite(source, "a coefficient of distortion", coefficient);
  }
  const std::size_t count = camera.distortion.size();
  const std::vector<std::size_t>& accepted = model->coefficients;
  if (count != 0 && std::find(accepted.begin(), accepted.end(), count) == accepted.end()) {
    std::string numbers = "0";
    for (const std::size_t number : accepted) {
      numbers += " or " + std::to_string(number);
    }
    throw Error(source + ": distortion has " + std::to_string(count) + " coefficients, expected " +
                numbers + " for " + camera.distortion_model);
  }
}

}  // namespace

void validateCamera(const Camera& camera, const std::string& source) {
  if (camera.width <= 0 || camera.height <= 0) {
    throw Error(source + ": image size is " + std::to_string(camera.width) + " x " +
                std::to_string(camera.height) + ", expected positive numbers of pixels");
  }
  requireFocalLength(source, "fx", camera.fx);
  requireFocalLength(source, "fy", camera.fy);
  requireFinite(source, "cx", camera.cx);
  requireFinite(source, "cy", camera.cy);
  requireFinite(source, "depth_factor", camera.depth_factor);
  if (camera.depth_factor <= 0) {
    throw Error(source + ": depth_factor is " + formatDouble(camera.depth_factor) +
                ", expected a positive number of depth units per metre");
  }
  requireKnownDistortion(source, camera);
}

bool hasDistortion(const Camera& camera) {
  // Without coefficients that differ from zero the image of an equidistant lens still grows with
  // the angle.
  return camera.distortion_model == "equidistant"
             ? !camera.distortion.empty()
             : std::any_of(camera.distortion.begin(), camera.distortion.end(),
                           [](double coefficient) { return coefficient != 0; });
}

bool sameIntrinsics(const Camera& a, const Camera& b) {
  const bool same_lens = (!hasDistortion(a) && !hasDistortion(b)) ||
                         (a.distortion_model == b.distortion_model && a.distortion == b.distortion);
  return same_lens && a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy;
}

}  // namespace evolin
