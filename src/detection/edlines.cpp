// EDLines: edges, lines along them, validation.
#include "evolin_ros/detection/edlines.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "edge_drawing.h"
#include "edlines_fit.h"
#include "edlines_validation.h"
#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "smoothed_gradient.h"

namespace evolin {
namespace {

const char* const kOwner = "detector edlines";
constexpr int kShortestWindow = 9;  // pixels

/// The pixels with which a line begins: of fewer, chance would align too many.
std::size_t windowFor(const EdLinesParameters& parameters, cv::Size size) {
  if (parameters.min_line_length > 0) {
    return static_cast<std::size_t>(parameters.min_line_length);
  }
  const double log_tests = 2 * (std::log10(size.width) + std::log10(size.height));
  const auto meaningful = static_cast<int>(std::lround(-0.5 * log_tests / std::log10(0.125)));
  return static_cast<std::size_t>(std::max(meaningful, kShortestWindow));
}

}  // namespace

/// The buffers and stages behind EdLines.
class EdLines::Engine {
 public:
  explicit Engine(const EdLinesParameters& parameters)
      : parameters_(parameters),
        gradient_(parameters.kernel, parameters.sigma, DerivativeFilter::kPrewittStrength),
        drawing_(parameters),
        fitter_(parameters),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    gradient_.compute(gray, parameters_.gradient_threshold, &maps_);
    const PixelChains& chains = drawing_.draw(&maps_);
    const std::size_t window = windowFor(parameters_, gray.size());
    fitted_.clear();
    for (std::size_t i = 0; i < chains.size(); ++i) {
      const std::size_t from = fitted_.size();
      fitter_.fit(chains.data(i), chains.length(i), window, &fitted_);
      fitter_.join(from, &fitted_);
    }
    validation_.start(gray);
    LineSegments lines;
    lines.reserve(fitted_.size());
    for (const edlines::FittedLine& line : fitted_) {
      if (!parameters_.validate || validation_.isMeaningful(line)) {
        lines.push_back(line.segment);
      }
    }
    return filter_.apply(std::move(lines), gray.size(), kOwner);
  }

 private:
  EdLinesParameters parameters_;
  GreyImage gray_;
  SmoothedGradient gradient_;
  GradientMaps maps_;
  edlines::EdgeDrawing drawing_;
  edlines::LineFitter fitter_;
  edlines::Validation validation_;
  std::vector<edlines::FittedLine> fitted_;
  LineFilter filter_;
};

EdLines::EdLines() = default;
EdLines::~EdLines() = default;

void EdLines::configure(const YAML::Node& parameters) {
  EdLinesParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("kernel", &read.kernel, 1, kMaxSmoothingKernel);
  reader.read("sigma", &read.sigma, 0.1, 10.0);
  reader.read("gradient_threshold", &read.gradient_threshold, 1, 1530);
  reader.read("anchor_threshold", &read.anchor_threshold, 0, 1530);
  reader.read("scan_interval", &read.scan_interval, 1, 64);
  reader.read("min_path_length", &read.min_path_length, 2, 100000);
  reader.read("min_line_length", &read.min_line_length, 0, 1000);
  reader.read("first_fit_error", &read.first_fit_error, 0.01, 10.0);
  reader.read("pixel_distance", &read.pixel_distance, 0.01, 10.0);
  reader.read("join_distance", &read.join_distance, 0.0, 1000.0);
  reader.read("join_error", &read.join_error, 0.001, 100.0);
  reader.read("validate", &read.validate);
  readSelection(&reader, &read.selection);
  reader.finish();
  if (read.kernel % 2 == 0) {
    throw ConfigError(kOwner, "kernel",
                      "expected an odd number of pixels, got " + std::to_string(read.kernel));
  }
  if (read.min_line_length == 1 || read.min_line_length == 2) {
    throw ConfigError(kOwner, "min_line_length",
                      "expected 0 (from the image's size) or at least 3 pixels, got " +
                          std::to_string(read.min_line_length));
  }
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments EdLines::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
