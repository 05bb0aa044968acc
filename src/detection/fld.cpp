// The fast line detector: parameters and selection.
#include "evolin_ros/detection/fld.h"

#include "evolin_ros/base/error.h"
#include "fld_lines.h"
#include "grey_image.h"
#include "opencv_support.h"

namespace evolin {
namespace {

const char* const kOwner = "detector fld";

}  // namespace

/// The buffers and stages behind Fld.
class Fld::Engine {
 public:
  explicit Engine(const FldParameters& parameters)
      : finder_(parameters), filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    return filter_.apply(finder_.find(gray), gray.size(), kOwner);
  }

 private:
  GreyImage gray_;
  fld::LineFinder finder_;
  LineFilter filter_;
};

Fld::Fld() = default;
Fld::~Fld() = default;

void Fld::configure(const YAML::Node& parameters) {
  FldParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("length_threshold", &read.length_threshold, 2, 1000);
  reader.read("distance_threshold", &read.distance_threshold, 0.001, 100.0);
  reader.read("canny_threshold1", &read.canny_threshold1, 0.001, 100000.0);
  reader.read("canny_threshold2", &read.canny_threshold2, 0.001, 100000.0);
  reader.read("canny_aperture", &read.canny_aperture, 3, 7);
  readSelection(&reader, &read.selection);
  reader.finish();
  requireOddAperture(kOwner, read.canny_aperture);
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Fld::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
