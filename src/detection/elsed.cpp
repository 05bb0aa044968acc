// ELSED: gradients, drawing, validation.
#include "evolin_ros/detection/elsed.h"

#include <cmath>

#include "elsed_drawing.h"
#include "elsed_validation.h"
#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "smoothed_gradient.h"

namespace evolin {
namespace {

const char* const kOwner = "detector elsed";

}  // namespace

/// The buffers and stages behind Elsed.
class Elsed::Engine {
 public:
  explicit Engine(const ElsedParameters& parameters)
      : parameters_(parameters),
        gradient_(parameters.kernel, parameters.sigma),
        drawing_(parameters),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    gradient_.compute(gray, parameters_.gradient_threshold, &maps_);
    drawing_.draw(maps_);
    LineSegments lines;
    lines.reserve(drawing_.segments().size());
    for (const elsed::DrawnSegment& segment : drawing_.segments()) {
      const auto [x1, y1] = segment.line.project(segment.first.x, segment.first.y);
      const auto [x2, y2] = segment.line.project(segment.last.x, segment.last.y);
      LineSegment line{x1, y1, x2, y2};
      if (!(line.length() > 0)) {
        continue;
      }
      const elsed::Verdict verdict =
          elsed::validate(drawing_, segment, maps_, parameters_.validation_threshold);
      if (parameters_.validate && verdict.agreeing <= verdict.disagreeing) {
        continue;
      }
      line.score = static_cast<double>(parameters_.validate ? verdict.agreeing : segment.size);
      lines.push_back(line);
    }
    return filter_.apply(std::move(lines), gray.size(), kOwner);
  }

 private:
  ElsedParameters parameters_;
  GreyImage gray_;
  SmoothedGradient gradient_;
  GradientMaps maps_;
  elsed::Drawing drawing_;
  LineFilter filter_;
};

Elsed::Elsed() = default;
Elsed::~Elsed() = default;

void Elsed::configure(const YAML::Node& parameters) {
  ElsedParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("kernel", &read.kernel, 1, kMaxSmoothingKernel);
  reader.read("sigma", &read.sigma, 0.1, 10.0);
  reader.read("gradient_threshold", &read.gradient_threshold, 1, 2040);
  reader.read("anchor_threshold", &read.anchor_threshold, 0, 2040);
  reader.read("scan_interval", &read.scan_interval, 1, 64);
  reader.read("min_line_length", &read.min_line_length, 4, 1000);
  reader.read("line_fit_error", &read.line_fit_error, 0.001, 100.0);
  reader.read("pixel_distance", &read.pixel_distance, 0.1, 10.0);
  reader.read("max_outliers", &read.max_outliers, 0, 100);
  reader.read("junctions", &read.junctions);
  reader.read("junction_eigenvalues", &read.junction_eigenvalues, 1.0, 1e6);
  reader.read("junction_angle", &read.junction_angle, 0.0, 90.0);
  reader.read("validate", &read.validate);
  reader.read("validation_threshold", &read.validation_threshold, 0.001, 1.5);
  readSelection(&reader, &read.selection);
  reader.finish();
  if (read.kernel % 2 == 0) {
    throw ConfigError(kOwner, "kernel",
                      "expected an odd number of pixels, got " + std::to_string(read.kernel));
  }
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Elsed::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
