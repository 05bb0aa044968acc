// LSD: level lines, regions, rectangles, validation.
#include "evolin_ros/detection/lsd.h"

#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "lsd_lines.h"

namespace evolin {
namespace {

const char* const kOwner = "detector lsd";

}  // namespace

/// The buffers and stages behind Lsd.
class Lsd::Engine {
 public:
  explicit Engine(const LsdParameters& parameters)
      : finder_(
            parameters,
            {parameters.compatible ? lsd::SeedOrder::kIntrosort : lsd::SeedOrder::kStrength, true}),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    return filter_.apply(finder_.find(gray), gray.size(), kOwner);
  }

 private:
  GreyImage gray_;
  lsd::LineFinder finder_;
  LineFilter filter_;
};

Lsd::Lsd() = default;
Lsd::~Lsd() = default;

void Lsd::configure(const YAML::Node& parameters) {
  LsdParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("refine", &read.refine, {"none", "standard", "advanced"});
  reader.read("scale", &read.scale, 0.1, 4.0);
  reader.read("sigma_scale", &read.sigma_scale, 0.01, 10.0);
  reader.read("quantization", &read.quantization, 0.0, 255.0);
  reader.read("angle_tolerance", &read.angle_tolerance, 0.1, 89.0);
  reader.read("log_eps", &read.log_eps, -1000.0, 1000.0);
  reader.read("density_threshold", &read.density_threshold, 0.0, 0.99);
  reader.read("bins", &read.bins, 1, 65536);
  reader.read("compatible", &read.compatible);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Lsd::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
