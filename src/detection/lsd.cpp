// LSD: level lines, regions, rectangles, validation.
#include "evolin_ros/detection/lsd.h"

#include <cmath>
#include <utility>

#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "lsd_field.h"
#include "lsd_region.h"
#include "lsd_validation.h"

namespace evolin {
namespace {

const char* const kOwner = "detector lsd";

}  // namespace

/// The buffers and stages behind Lsd.
class Lsd::Engine {
 public:
  explicit Engine(const LsdParameters& parameters)
      : parameters_(parameters),
        builder_(parameters),
        validation_(parameters.compatible),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    builder_.build(gray, &field_);
    found_.clear();
    if (field_.size() > 0) {
      findLines();
    }
    return filter_.apply(LineSegments(found_), gray.size(), kOwner);
  }

 private:
  void findLines() {
    const double tolerance = parameters_.angle_tolerance * CV_PI / 180;
    const double chance = parameters_.angle_tolerance / 180;
    const bool standard = parameters_.refine != "none";
    const bool advanced = parameters_.refine == "advanced";
    grower_.start(field_);
    validation_.start(field_);
    // Smaller regions cannot be meaningful, however well they are aligned.
    const auto fewest = static_cast<std::size_t>(-validation_.logTests() / std::log10(chance));
    for (const std::int32_t seed : field_.seeds) {
      if (!grower_.isFree(seed)) {
        continue;
      }
      grower_.grow(seed, tolerance);
      if (grower_.size() < fewest) {
        continue;
      }
      lsd::Rectangle rectangle = grower_.fit(tolerance, chance);
      if (standard && !grower_.refine(parameters_.density_threshold, &rectangle)) {
        continue;
      }
      double score = kNoScore;
      if (advanced) {
        score = validation_.improve(parameters_.log_eps, &rectangle);
        if (!(score > parameters_.log_eps)) {
          continue;
        }
      }
      // A level line runs through the corner between four pixels.
      const auto place = [&](double coordinate) { return (coordinate + 0.5) / parameters_.scale; };
      found_.push_back({place(rectangle.x1), place(rectangle.y1), place(rectangle.x2),
                        place(rectangle.y2), score});
    }
  }

  LsdParameters parameters_;
  GreyImage gray_;
  lsd::FieldBuilder builder_;
  lsd::Field field_;
  lsd::RegionGrower grower_;
  lsd::Validation validation_;
  LineSegments found_;
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
