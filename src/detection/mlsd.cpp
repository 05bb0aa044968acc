// M-LSD: the network's interface, parameters, one frame's way through it.
#include "evolin_ros/detection/mlsd.h"

#include <utility>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/inference/image_tensor.h"
#include "mlsd_decoding.h"

namespace evolin {
namespace {

const char* const kOwner = "detector mlsd";

NetworkInterface interface() {
  NetworkInterface mlsd;
  mlsd.owner = kOwner;
  mlsd.input = {"image", {1, 3, -1, -1}};
  mlsd.outputs = {{"maps", {1, 5, -1, -1}}};
  mlsd.how_to_get =
      "'scripts/models/convert mlsd' makes it of the authors' weights (docs/NETWORKS.md).";
  return mlsd;
}

ImageTensorOptions inputOf(const std::vector<int>& shape) {
  ImageTensorOptions options;
  options.size = cv::Size(shape[3], shape[2]);
  options.interpolation = cv::INTER_AREA;
  options.divisor = 127.5F;
  options.mean = {1, 1, 1};
  return options;
}

mlsd::DecodingOptions decodingOf(const MlsdParameters& parameters) {
  mlsd::DecodingOptions options;
  options.score_threshold = parameters.selection.score_threshold;
  options.min_grid_length = parameters.min_grid_length;
  options.candidates = parameters.candidates;
  return options;
}

}  // namespace

/// The stages behind Mlsd.
class Mlsd::Engine {
 public:
  explicit Engine(const MlsdParameters& parameters)
      : clip_(parameters.clip),
        filter_(parameters.selection),
        decoder_(decodingOf(parameters)),
        network_(interface(), parameters.network),
        tensor_(inputOf(network_.inputShape())) {}

  LineSegments detect(const Frame& frame, NetworkTimes* times) {
    StopWatch watch;
    const cv::Mat& input = tensor_.of(frame.image);
    times->preparing = watch.milliseconds();
    const cv::Mat& maps = network_.run(input).front();
    times->forward = network_.lastMilliseconds();
    watch.restart();
    LineSegments lines = decoder_.decode(maps, frame.image.size());
    lines = clip_ ? filter_.apply(std::move(lines), frame.image.size(), kOwner)
                  : filter_.applyUncut(std::move(lines), frame.image.size(), kOwner);
    times->decoding = watch.milliseconds();
    return lines;
  }

 private:
  bool clip_;
  LineFilter filter_;
  mlsd::Decoder decoder_;
  Network network_;
  ImageTensor tensor_;
};

Mlsd::Mlsd() = default;
Mlsd::~Mlsd() = default;

void Mlsd::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  MlsdParameters read;
  ParameterReader reader(parameters, kOwner);
  readNetworkOptions(&reader, &read.network);
  reader.read("min_grid_length", &read.min_grid_length, 0.0, 10000.0);
  reader.read("candidates", &read.candidates, 1, 100000);
  reader.read("clip", &read.clip);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Mlsd::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame, &times_);
}

}  // namespace evolin
