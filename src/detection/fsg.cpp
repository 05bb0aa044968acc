// FSG: LSD's segments and their groups.
#include "evolin_ros/detection/fsg.h"

#include "evolin_ros/base/error.h"
#include "fsg_grouping.h"
#include "grey_image.h"
#include "lsd_lines.h"

namespace evolin {
namespace {

const char* const kOwner = "detector fsg";

LsdParameters segmentParameters() {
  LsdParameters parameters;
  parameters.refine = "standard";
  return parameters;
}

}  // namespace

/// The buffers and stages behind Fsg.
class Fsg::Engine {
 public:
  explicit Engine(const FsgParameters& parameters)
      : finder_(segmentParameters(), {lsd::SeedOrder::kRows, false}),
        grouping_(parameters),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    return filter_.apply(grouping_.run(finder_.find(gray), gray.size()), gray.size(), kOwner);
  }

 private:
  GreyImage gray_;
  lsd::LineFinder finder_;
  fsg::Grouping grouping_;
  LineFilter filter_;
};

Fsg::Fsg() = default;
Fsg::~Fsg() = default;

void Fsg::configure(const YAML::Node& parameters) {
  FsgParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("endpoint_error", &read.endpoint_error, 0.5, 100.0);
  reader.read("max_overlap", &read.max_overlap, 0.0, 1.0);
  reader.read("max_gap", &read.max_gap, 0.0, 1000.0);
  reader.read("orientation_bins", &read.orientation_bins, 3, 1000);
  reader.read("length_bins", &read.length_bins, 1, 100000);
  reader.read("segment_density", &read.segment_density, 1.0, 1e6);
  reader.read("min_line_length", &read.min_line_length, 0.0, 100000.0);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Fsg::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
