// CannyLines: parameters and selection.
#include "evolin_ros/detection/cannylines.h"

#include "cannylines_edges.h"
#include "cannylines_lines.h"
#include "evolin_ros/base/error.h"
#include "grey_image.h"

namespace evolin {
namespace {

const char* const kOwner = "detector cannylines";

}  // namespace

/// The buffers and stages behind CannyLines.
class CannyLines::Engine {
 public:
  explicit Engine(const CannyLinesParameters& parameters)
      : edges_(parameters), lines_(parameters), filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    edges_.find(gray);
    return filter_.apply(lines_.find(edges_), gray.size(), kOwner);
  }

 private:
  GreyImage gray_;
  cannylines::EdgeFinder edges_;
  cannylines::LineFinder lines_;
  LineFilter filter_;
};

CannyLines::CannyLines() = default;
CannyLines::~CannyLines() = default;

void CannyLines::configure(const YAML::Node& parameters) {
  CannyLinesParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("sigma", &read.sigma, 0.1, 10.0);
  reader.read("meaningful_gradient", &read.meaningful_gradient, 1.0, 2040.0);
  reader.read("fit_error", &read.fit_error, 0.01, 10.0);
  reader.read("validate", &read.validate);
  reader.read("compatible", &read.compatible);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments CannyLines::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
